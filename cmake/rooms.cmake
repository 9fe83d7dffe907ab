# One library per room, one test program per room.

add_compile_options(-Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
# What g++ 12 sees in every copied std::variant of Eigen members, boost small_vector and
# std::string is not there.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
                    $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overread>
                    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# Results must not depend on which machine compiled them: no contraction into fused operations.
add_compile_options(-ffp-contract=off)
if(ANCHORD_SANITIZE)
  add_compile_options(-fsanitize=${ANCHORD_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ANCHORD_SANITIZE})
  if(ANCHORD_SANITIZE MATCHES thread)
    # Asio has fences, which g++'s ThreadSanitizer does not see and says so.
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
  endif()
endif()

# anchord_room(NAME SOURCES a.cc ... DEPENDS core Eigen3::Eigen ...)
# makes the library anchord_NAME (alias anchord::NAME). Headers are included as "NAME/header.h".
function(anchord_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS" ${ARGN})
  set(target anchord_${name})
  if(ROOM_SOURCES)
    add_library(${target} STATIC ${ROOM_SOURCES})
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(anchord::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
                                                $<INSTALL_INTERFACE:include/anchord>)
  target_link_libraries(${target} ${scope} ${ROOM_DEPENDS})
endfunction()

# anchord_test(NAME SOURCES a_test.cc ... DEPENDS anchord::core ...)
# makes the program NAME_test and registers each of its cases with ctest.
function(anchord_test name)
  cmake_parse_arguments(TEST "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name}_test ${TEST_SOURCES})
  target_link_libraries(${name}_test PRIVATE ${TEST_DEPENDS} GTest::gtest GTest::gtest_main)
  gtest_discover_tests(${name}_test TEST_PREFIX "${name}/" DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT 300)
endfunction()
