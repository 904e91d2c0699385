# SPDX-License-Identifier: Apache-2.0
# cmake -DBUILD=<build folder> -DFIRST=<prefix> -DTHEN=<where the tree is moved> -P install_and_move.cmake
file(REMOVE_RECURSE "${FIRST}" "${THEN}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${FIRST}" COMMAND_ERROR_IS_FATAL ANY)
file(RENAME "${FIRST}" "${THEN}")
