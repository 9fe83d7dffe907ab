# The LCM types, compiled by lcm-gen at build time.

find_program(LCM_GEN lcm-gen REQUIRED)

# anchord_lcm_types(NAME a_t.lcm b_t.lcm ...)
# makes the interface library anchord_NAME (alias anchord::NAME), whose headers are included as
# <anchord/a_t.hpp>, and the Python package `anchord` in the build tree's python/ folder.
# Every type must be of package `anchord`.
function(anchord_lcm_types name)
  set(target anchord_${name})
  set(cpp_root ${CMAKE_CURRENT_BINARY_DIR}/cpp)
  set(python_root ${CMAKE_CURRENT_BINARY_DIR}/python)
  set(headers)
  set(modules ${python_root}/anchord/__init__.py)
  foreach(type ${ARGN})
    cmake_path(GET type STEM stem)
    list(APPEND headers ${cpp_root}/anchord/${stem}.hpp)
    list(APPEND modules ${python_root}/anchord/${stem}.py)
  endforeach()

  # lcm-gen leaves out of date __init__.py files alone but for what it adds: start from nothing.
  add_custom_command(
    OUTPUT ${headers} ${modules}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${cpp_root} ${python_root}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${cpp_root} ${python_root}
    COMMAND ${LCM_GEN} -x --cpp-std=c++11 --cpp-hpath ${cpp_root}
            -p --ppath ${python_root} ${ARGN}
    DEPENDS ${ARGN}
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
    COMMENT "Generating the LCM types in C++ and Python"
    VERBATIM)
  add_custom_target(${target}_generate ALL DEPENDS ${headers} ${modules})

  add_library(${target} INTERFACE)
  add_library(anchord::${name} ALIAS ${target})
  add_dependencies(${target} ${target}_generate)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  # SYSTEM: generated code is not held to the project's warnings. It needs LCM's headers only.
  target_include_directories(${target} SYSTEM
                             INTERFACE $<BUILD_INTERFACE:${cpp_root}>
                                       $<INSTALL_INTERFACE:include/anchord/lcmtypes>)

  install(TARGETS ${target} EXPORT anchordTargets)
  install(FILES ${headers} DESTINATION include/anchord/lcmtypes/anchord)
  install(FILES ${modules} DESTINATION lib/python3/dist-packages/anchord)
  install(FILES ${ARGN} DESTINATION share/anchord/lcmtypes)
endfunction()
