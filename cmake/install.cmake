# What `cmake --install` puts where: the programs, the configurations, the service, and a package
# `anchord` for find_package() with the libraries that C++ programs may link.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The rooms of the engine and the types. lcm_types, the generated ones, install themselves.
set(ANCHORD_LIBRARY core lcmtypes geometry models knowledge mht anchoring)
target_compile_features(anchord_core INTERFACE cxx_std_20)  # what users' compilers must be told
foreach(room IN LISTS ANCHORD_LIBRARY)
  install(TARGETS anchord_${room} EXPORT anchordTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${room} DESTINATION include/anchord
          FILES_MATCHING PATTERN "*.h")
endforeach()

set(ANCHORD_PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/anchord)
install(EXPORT anchordTargets NAMESPACE anchord:: DESTINATION ${ANCHORD_PACKAGE})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/anchordConfig.cmake.in ${CMAKE_BINARY_DIR}/anchordConfig.cmake
  INSTALL_DESTINATION ${ANCHORD_PACKAGE})
write_basic_package_version_file(
  ${CMAKE_BINARY_DIR}/anchordConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/anchordConfig.cmake ${CMAKE_BINARY_DIR}/anchordConfigVersion.cmake
        DESTINATION ${ANCHORD_PACKAGE})

# Every program of daemon/ and tools/, and of the folders below them.
function(anchord_install_programs folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "EXECUTABLE")
      install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    endif()
  endforeach()
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(next IN LISTS below)
    anchord_install_programs(${next})
  endforeach()
endfunction()
anchord_install_programs(${CMAKE_SOURCE_DIR}/daemon)
anchord_install_programs(${CMAKE_SOURCE_DIR}/tools)

install(DIRECTORY ${CMAKE_SOURCE_DIR}/config DESTINATION share/anchord)
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
configure_file(${CMAKE_SOURCE_DIR}/daemon/anchord.service.in ${CMAKE_BINARY_DIR}/anchord.service @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/anchord.service DESTINATION lib/systemd/system)
