# SPDX-License-Identifier: MIT
# Bundles the page, if its packages are there.
if(NOT EXISTS ${PACKAGES})
  return()
endif()
execute_process(COMMAND ${NODE} build.mjs ${FOLDER} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the page can't be bundled")
endif()
file(TOUCH ${STAMP})
