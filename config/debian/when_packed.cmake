# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Read by cpack: the version with the commit and its day, which tools/package knows.
set(CPACK_DEBIAN_PACKAGE_VERSION "$ENV{TREAD_PACKAGE_VERSION}")
if(NOT CPACK_DEBIAN_PACKAGE_VERSION)
  message(FATAL_ERROR "the packages are made by tools/package")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_LAB_PACKAGE_DEPENDS "tread (= ${CPACK_DEBIAN_PACKAGE_VERSION}-1)")
