// SPDX-License-Identifier: BSD-3-Clause
#include "study/study_keys.hpp"

#include "scene/key_reference.hpp"

namespace vsb::app {

std::string study_key_reference() {
  return key_reference(study_keys,
                       "# Keys of a study\n\n"
                       "Every table and every key that a study may have, as `vsb keys --study` prints them "
                       "from the declarations by which\n"
                       "studies are read. The guide is `apps/studies/README.md`; the keys of the scenes are "
                       "in `apps/scenes/keys.md`.\n");
}

}  // namespace vsb::app
