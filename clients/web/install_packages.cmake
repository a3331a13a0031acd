# SPDX-License-Identifier: MIT
# Installs what package-lock.json names. Without the registry and a cache the build goes on without it.
execute_process(
  COMMAND ${NPM} ci --ignore-scripts --prefer-offline --no-audit --no-fund --loglevel=error
          --fetch-retries=1 --fetch-timeout=60000
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0)
  file(TOUCH ${STAMP})
else()
  message(WARNING "${WHAT} is not built: npm can't get its packages. Everything else is built. "
                  "With a network, build again.\n${output}")
endif()
