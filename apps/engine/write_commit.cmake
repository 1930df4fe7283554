# SPDX-License-Identifier: BSD-3-Clause
# cmake -DSOURCE=... -DHEADER=... -P write_commit.cmake: the commit of SOURCE as a C++ header, touched only on change.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  set(commit unknown)
endif()
set(text "// SPDX-License-Identifier: BSD-3-Clause\n#pragma once\n#define VSB_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS "${HEADER}")
  file(READ "${HEADER}" old)
endif()
if(NOT old STREQUAL text)
  file(WRITE "${HEADER}" "${text}")
endif()
