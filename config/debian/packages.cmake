# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Debian's packages: tread (what runs on the robot, and what its operator needs) and tread-lab (what an engineer needs at
# the desk). tools/package makes them.

# Manual pages, of what --help says: only for the packages (target tread_man).
find_program(HELP2MAN help2man)
if(HELP2MAN)
  add_custom_target(tread_man)
endif()
# All that they hold.
add_custom_target(tread_packaged)
if(TARGET tread_lcmtypes_jar)
  add_dependencies(tread_packaged tread_lcmtypes_jar)
endif()
foreach(package robot lab)
  get_property(programs GLOBAL PROPERTY TREAD_${package}_PROGRAMS)
  set(pages ${CMAKE_BINARY_DIR}/man/${package})
  file(MAKE_DIRECTORY ${pages})
  if(HELP2MAN)
    add_custom_command(TARGET tread_man POST_BUILD
                       COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/debian/man-pages ${CMAKE_RUNTIME_OUTPUT_DIRECTORY} ${pages}
                               ${programs}
                       VERBATIM)
  endif()
  list(REMOVE_ITEM programs tread-spy)  # a script
  add_dependencies(tread_packaged ${programs})
endforeach()
if(HELP2MAN)
  add_dependencies(tread_man tread_packaged)
endif()
install(DIRECTORY ${CMAKE_BINARY_DIR}/man/robot/ DESTINATION share/man/man1 COMPONENT config)
install(DIRECTORY ${CMAKE_BINARY_DIR}/man/lab/ DESTINATION share/man/man1 COMPONENT lab)

# The manuals, in the folders in which README.md names them.
file(GLOB_RECURSE manuals RELATIVE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/common/README.md
     ${CMAKE_SOURCE_DIR}/lcmtypes/README.md ${CMAKE_SOURCE_DIR}/modules/README.md
     ${CMAKE_SOURCE_DIR}/tools/robot/README.md ${CMAKE_SOURCE_DIR}/tools/lab/README.md)
list(FILTER manuals EXCLUDE REGEX node_modules)
foreach(manual IN LISTS manuals ITEMS README.md)
  get_filename_component(folder ${manual} DIRECTORY)
  if(folder MATCHES "^tools/lab")
    install(FILES ${CMAKE_SOURCE_DIR}/${manual} DESTINATION share/doc/tread-lab/${folder} COMPONENT lab)
  else()
    install(FILES ${CMAKE_SOURCE_DIR}/${manual} DESTINATION share/doc/tread/${folder} COMPONENT config)
  endif()
endforeach()

# Copyright and changes stand in each package. changelog.gz is what changed in Tread; changelog.Debian.gz, which package
# this is, is known only when it is made.
set(debian ${CMAKE_BINARY_DIR}/debian)
foreach(name tread:config tread-lab:lab)
  string(REPLACE ":" ";" name ${name})
  list(POP_FRONT name package)
  install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/debian/copyright ${debian}/changelog.gz ${debian}/${package}/changelog.Debian.gz
          DESTINATION share/doc/${package} COMPONENT ${name} OPTIONAL)
endforeach()

# What people may edit. A robot's limits are among it: a newer package must not replace them.
function(list_conffiles package)
  set(lines "")
  foreach(folder IN LISTS ARGN)
    file(GLOB_RECURSE files RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*)
    foreach(file IN LISTS files)
      string(APPEND lines "/etc/tread/${file}\n")
    endforeach()
  endforeach()
  file(WRITE ${debian}/${package}/conffiles ${lines})
endfunction()
list_conffiles(tread ${robot_folders})
list_conffiles(tread-lab ${lab_folders})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tread)
set(CPACK_PACKAGE_VENDOR Tread)
set(CPACK_PACKAGE_CONTACT "The Tread authors")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs config lab)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_PROGRAMS_GROUP robot)
set(CPACK_COMPONENT_CONFIG_GROUP robot)
set(CPACK_COMPONENT_LAB_GROUP lab)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ROBOT_PACKAGE_NAME tread)
set(CPACK_DEBIAN_LAB_PACKAGE_NAME tread-lab)
set(CPACK_DEBIAN_ROBOT_DESCRIPTION "open-loop off-road navigation that learns the ground
The processes of a robot with tracks, wheels or an omnidirectional base that
takes motor power and has no wheel encoders, what its operator needs, and a
simulator behind the devices' protocols. Messages go over LCM.")
set(CPACK_DEBIAN_LAB_DESCRIPTION "what an engineer needs beside tread
Finds and names the gap between a vehicle's model and its measured drives,
replays logs through the robot's processes, drives missions in virtual time
and compares rules of learning.")
# ip sets LCM's route. lcm-spy's needs are many and only for tread-spy.
set(CPACK_DEBIAN_ROBOT_PACKAGE_DEPENDS "iproute2")
set(CPACK_DEBIAN_ROBOT_PACKAGE_SUGGESTS "liblcm-bin, liblcm-java, libjchart2d-java, default-jre")
# For who links its cores.
set(CPACK_DEBIAN_LAB_PACKAGE_SUGGESTS "g++, cmake, libeigen3-dev, libmrpt-poses-dev")
set(CPACK_DEBIAN_ROBOT_PACKAGE_CONTROL_EXTRA ${debian}/tread/conffiles ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst
    ${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm)
set(CPACK_DEBIAN_LAB_PACKAGE_CONTROL_EXTRA "${debian}/tread-lab/conffiles")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_SOURCE_DIR}/debian/when_packed.cmake)
include(CPack)
