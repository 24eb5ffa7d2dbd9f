# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# cmake -DSOURCE=... -DTREAD_VERSION=... -DOUTPUT=... -P version.cmake: writes OUTPUT if the commit is another one.
# Only a checkout of our own counts: an archive may lie inside somebody else's.
set(TREAD_COMMIT "")
if(EXISTS ${SOURCE}/.git)
  # safe.directory: a checkout may be another user's.
  execute_process(COMMAND git -c safe.directory=* describe --always --dirty --abbrev=12 --exclude=*
                  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE TREAD_COMMIT ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
if(NOT TREAD_COMMIT)
  file(STRINGS ${SOURCE}/common/config/archived_commit.txt TREAD_COMMIT LIMIT_COUNT 1)
  if(NOT TREAD_COMMIT MATCHES "^[0-9a-f]+$")  # not from git archive
    set(TREAD_COMMIT "")
  endif()
endif()
configure_file(${SOURCE}/common/config/version.cpp.in ${OUTPUT} @ONLY)  # leaves the file alone if nothing changes
