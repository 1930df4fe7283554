# SPDX-License-Identifier: BSD-3-Clause
# The target `docs`: the API reference as HTML, from the comments of the library.
find_program(VSB_DOXYGEN doxygen DOC "Doxygen, for the target docs")
mark_as_advanced(VSB_DOXYGEN)
set(vsb_docs_dir "${PROJECT_BINARY_DIR}/docs")
if(VSB_DOXYGEN)
  add_custom_target(docs
    COMMAND ${CMAKE_COMMAND} -E env "VSB_DOCS=${vsb_docs_dir}" ${VSB_DOXYGEN} kernels/Doxyfile
    COMMAND ${CMAKE_COMMAND} -E echo "The API reference begins with ${vsb_docs_dir}/index.html"
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
else()
  add_custom_target(docs
    COMMAND ${CMAKE_COMMAND} -E echo "The API reference needs doxygen, which was not found: install it, and configure again."
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
endif()
