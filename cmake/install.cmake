# What `cmake --install` puts where, beside the programs and the LCM types, which do so themselves:
# the configurations, the service, the manual, and a package `anchord` for find_package() with the
# libraries that C++ programs may link.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

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

install(DIRECTORY ${CMAKE_SOURCE_DIR}/config DESTINATION share/anchord)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/build/viewer DESTINATION share/anchord OPTIONAL)  # once bundled
install(FILES daemon/openapi.json DESTINATION share/anchord)
file(GLOB ANCHORD_PAGES ${CMAKE_SOURCE_DIR}/docs/man/*.[18])
if(NOT ANCHORD_PERCEPTION)
  list(FILTER ANCHORD_PAGES EXCLUDE REGEX "anchor-(detect|verify)")
endif()
if(ANCHORD_PACKAGE)
  set(ANCHORD_UNITS /lib/systemd/system)
  set(ANCHORD_UNIT_CONFIG /etc/anchord/home.json)
  include(cmake/package.cmake)
else()
  set(ANCHORD_UNITS lib/systemd/system)
  set(ANCHORD_UNIT_CONFIG ${CMAKE_INSTALL_FULL_DATADIR}/anchord/config/home.json)
  install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
  foreach(page IN LISTS ANCHORD_PAGES)
    string(REGEX MATCH "[18]$" section ${page})
    install(FILES ${page} DESTINATION share/man/man${section})
  endforeach()
endif()
configure_file(${CMAKE_SOURCE_DIR}/daemon/anchord.service.in ${CMAKE_BINARY_DIR}/anchord.service
               @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/anchord.service DESTINATION ${ANCHORD_UNITS})
install(FILES ${CMAKE_SOURCE_DIR}/daemon/20-anchord.conf DESTINATION lib/sysctl.d)
