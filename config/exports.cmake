# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# What other projects may link: find_package(tread), then tread::learner (patterns and their learner) or
# tread::identification. tests/packages/examples shows each. They are in the package tread-lab.
include(CMakePackageConfigHelpers)
set(exported tread_options tread_enums tread_learner_core tread_gap_core tread_log_validation tread_execution tread_stop_reason tread_geometry
    tread_grid tread_ground tread_omni_wheels tread_parallel tread_pattern tread_vehicle)
foreach(target IN LISTS exported)
  string(REPLACE tread_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
set_target_properties(tread_learner_core PROPERTIES EXPORT_NAME learner)
set_target_properties(tread_gap_core PROPERTIES EXPORT_NAME identification)
install(TARGETS ${exported} EXPORT tread ARCHIVE DESTINATION lib/tread COMPONENT lab)

foreach(folder common/execution common/geometry common/grid common/ground common/parallel common/pattern
               common/soundness/core common/vehicle common/words modules/identification/core modules/learner/core)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder}/ DESTINATION include/tread/${folder} COMPONENT lab
          FILES_MATCHING PATTERN *.hpp)
endforeach()
install(FILES ${CMAKE_BINARY_DIR}/lcmtypes/plain/lcmtypes/enums.hpp DESTINATION include/tread/lcmtypes COMPONENT lab)

set(exports ${CMAKE_CURRENT_BINARY_DIR}/exports)
file(WRITE ${exports}/tread-config.cmake [[
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(mrpt-poses 2.5)
find_dependency(muparser 2.3)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/tread-targets.cmake)
]])
write_basic_package_version_file(${exports}/tread-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${exports}/tread-config.cmake ${exports}/tread-config-version.cmake DESTINATION lib/cmake/tread
        COMPONENT lab)
install(EXPORT tread NAMESPACE tread:: FILE tread-targets.cmake DESTINATION lib/cmake/tread COMPONENT lab)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/tests/packages/examples DESTINATION share/doc/tread-lab COMPONENT lab)
