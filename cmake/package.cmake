# The Debian package, built by CPack (./dev package): what cmake/install.cmake installs, with the
# prefix /usr, and what belongs to the machine: its configuration, the service, the manual as Debian
# has it.

set(ANCHORD_PACKAGING ${CMAKE_SOURCE_DIR}/packaging)

# compressed(FILE DESTINATION NAME): installs it as NAME.gz, the same bytes every time.
function(compressed file destination name)
  set(packed ${CMAKE_BINARY_DIR}/compressed/${name}.gz)
  add_custom_command(
    OUTPUT ${packed}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/compressed
    COMMAND gzip -9nc ${file} > ${packed}
    DEPENDS ${file}
    VERBATIM)
  set_property(GLOBAL APPEND PROPERTY ANCHORD_COMPRESSED ${packed})
  install(FILES ${packed} DESTINATION ${destination})
endfunction()

foreach(page IN LISTS ANCHORD_PAGES)
  cmake_path(GET page EXTENSION LAST_ONLY section)
  string(SUBSTRING ${section} 1 -1 section)
  cmake_path(GET page FILENAME name)
  compressed(${page} share/man/man${section} ${name})
endforeach()
compressed(${ANCHORD_PACKAGING}/changelog share/doc/anchord changelog)
get_property(packed GLOBAL PROPERTY ANCHORD_COMPRESSED)
add_custom_target(package_files ALL DEPENDS ${packed})

install(FILES config/home.json DESTINATION /etc/anchord)
install(FILES ${ANCHORD_PACKAGING}/anchord.default DESTINATION /etc/default RENAME anchord)
install(FILES ${ANCHORD_PACKAGING}/copyright NOTICE README.md CHANGELOG.md docs/operations.md
              docs/formats.md docs/belief.md docs/verification.md docs/tuning.md
        DESTINATION share/doc/anchord)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME anchord)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The anchord authors <maintainers@anchord.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "semantic world model daemon for robots")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "Keeps track of the objects around a robot from what detectors report, frame by
frame, over LCM or HTTP: which objects exist, what they are, where they are
now, and how sure all of it is, by probabilistic multiple-hypothesis anchoring.
Has the daemon, its command line, tools for recordings, the LCM types for C++
and Python, and the engine as a C++ library.")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3, libeigen3-dev, libsqlite3-dev, liblcm-dev")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    ${ANCHORD_PACKAGING}/conffiles ${ANCHORD_PACKAGING}/postinst ${ANCHORD_PACKAGING}/prerm
    ${ANCHORD_PACKAGING}/postrm)
include(CPack)
