# What every target of our own code is built with.
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g -DNDEBUG")
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Sanitizers for everything that is built here (scripts/sanitize, scripts/fuzz): the first finding ends a program. With
# them the assertions of Eigen, Boost and the standard library, which see an index out of range that stays in memory.
set(DONEX_SANITIZE "" CACHE STRING "Sanitizers, as address,undefined or thread")
if(DONEX_SANITIZE)
  add_compile_options(-fsanitize=${DONEX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
  add_compile_options(-UNDEBUG -D_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=${DONEX_SANITIZE})
endif()

# donex_own_code(target): C++17, warnings are errors, public headers under include/, the others beside their sources.
# No floating-point contraction: the fast code must round exactly as the oracle does, on every machine.
function(donex_own_code target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -Werror)
  # g++ leaves these out of -Wconversion: an index of a loop may be signed.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)
  target_compile_options(${target} PUBLIC -ffp-contract=off)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>)
endfunction()

# donex_add_test(name LIBRARIES libs... SOURCES files...): a GoogleTest program known to CTest, and to
# catkin's run_tests where there is catkin. A test that has no main() of its own gets one.
function(donex_add_test name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;SOURCES" ${ARGN})
  if(DONEX_BUILD_ROS)
    catkin_add_gtest(${name} ${ARG_SOURCES})
  else()
    find_package(GTest REQUIRED)
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} GTest::GTest)
    add_test(NAME ${name} COMMAND ${name})
  endif()
  donex_test_code(${name} ${ARG_LIBRARIES})
endfunction()

# donex_test_code(target libs...): what every test program shares.
function(donex_test_code target)
  donex_own_code(${target})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  # Without a keyword, as catkin links GoogleTest: CMake forbids to mix the two forms.
  target_link_libraries(${target} ${ARGN} donex_test_main)
endfunction()
