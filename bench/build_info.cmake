# SPDX-License-Identifier: BSD-3-Clause
# Run at build time: fills TEMPLATE into HEADER with VERSION, BUILD_TYPE, FLAGS and the commit of SOURCE_DIR.
set(COMMIT "unknown")
execute_process(COMMAND git describe --always --dirty WORKING_DIRECTORY "${SOURCE_DIR}" OUTPUT_VARIABLE described
                ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE code)
if(code EQUAL 0 AND described)
  set(COMMIT "${described}")
endif()
configure_file("${TEMPLATE}" "${HEADER}" @ONLY)
