# pprt_flags: what every target of this project is compiled with.
add_library(pprt_flags INTERFACE)
target_include_directories(pprt_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(pprt_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                            -Wcast-align -Woverloaded-virtual
                                            # Results must not depend on whether the compiler fuses a*b+c.
                                            -ffp-contract=off)
# GCC 12 sees overlapping copies inside std::string's operators where there are none (GCC bug 105651), and with
# precompiled headers also copies of 2^63 bytes. Later compilers and clang-tidy look for these.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(pprt_flags INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
endif()
if(PPRT_WERROR)
  target_compile_options(pprt_flags INTERFACE -Werror)
endif()
if(PPRT_NATIVE)
  target_compile_options(pprt_flags INTERFACE -march=native)
endif()
if(PPRT_SANITIZE STREQUAL "thread")
  target_compile_options(pprt_flags INTERFACE -fsanitize=thread)
  target_link_options(pprt_flags INTERFACE -fsanitize=thread)
elseif(PPRT_SANITIZE)
  target_compile_options(pprt_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                              -fno-omit-frame-pointer)
  target_link_options(pprt_flags INTERFACE -fsanitize=address,undefined)
endif()
if(PPRT_TIDY)
  find_program(PPRT_CLANG_TIDY clang-tidy REQUIRED)
  set(CMAKE_CXX_CLANG_TIDY ${PPRT_CLANG_TIDY} --quiet)
endif()

# What nearly every source includes, compiled once for modules (pprt_pch), cold ones (pprt_cold_pch) and unit tests
# (pprt_test_pch).
# Sources include what they use all the same: with PPRT_PCH off each stands alone.
function(pprt_precompile target)
  target_link_libraries(${target} PRIVATE pprt_flags Imath::Imath)
  target_precompile_headers(${target} PRIVATE
    <algorithm> <array> <chrono> <cmath> <cstdint> <deque> <filesystem> <fstream> <functional> <limits> <map> <memory>
    <numeric> <optional> <random> <set> <span> <sstream> <stdexcept> <string> <string_view> <thread> <tuple>
    <unordered_map> <utility> <vector> <Imath/ImathBox.h> <Imath/ImathColor.h> <Imath/ImathVec.h> ${ARGN})
endfunction()
# Code that no frame and no measurement waits for: options, conversions, pages, studies and programs' mains. What takes
# their time is in other libraries, and compiling it is most of a build. That of unit tests is not optimised at all.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(PPRT_COLD_FLAGS -O1 -Wno-stringop-overread)  # which GCC 12 sees in short literals then
  set(PPRT_TEST_FLAGS -O0)
endif()
if(PPRT_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "int main() {}\n")
  add_library(pprt_pch OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
  pprt_precompile(pprt_pch)
  add_library(pprt_cold_pch OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
  target_compile_options(pprt_cold_pch PRIVATE ${PPRT_COLD_FLAGS})
  pprt_precompile(pprt_cold_pch)
  if(BUILD_TESTING)
    add_executable(pprt_test_pch ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
    target_link_libraries(pprt_test_pch PRIVATE Catch2::Catch2)
    target_compile_options(pprt_test_pch PRIVATE ${PPRT_TEST_FLAGS})
    if(Catch2_VERSION VERSION_GREATER_EQUAL 3)
      target_include_directories(pprt_test_pch PRIVATE ${PROJECT_SOURCE_DIR}/tests/catch2_3)
    endif()
    pprt_precompile(pprt_test_pch <catch2/catch.hpp>)
  endif()
endif()

# pprt_module(NAME [OWN_FLAGS] [COLD] SOURCES a.cpp ... USES other modules and public libraries ... HIDES private libraries ...)
# A module with flags of its own cannot use the common precompiled header. A cold one is compiled by PPRT_COLD_FLAGS.
function(pprt_module name)
  cmake_parse_arguments(M "OWN_FLAGS;COLD" "" "SOURCES;USES;HIDES" ${ARGN})
  add_library(pprt_${name} STATIC ${M_SOURCES})
  target_link_libraries(pprt_${name} PUBLIC pprt_flags ${M_USES} PRIVATE ${M_HIDES})
  set(precompiled pprt_pch)
  if(M_COLD)
    target_compile_options(pprt_${name} PRIVATE ${PPRT_COLD_FLAGS})
    set(precompiled pprt_cold_pch)
  endif()
  if(PPRT_PCH AND NOT M_OWN_FLAGS)
    target_precompile_headers(pprt_${name} REUSE_FROM ${precompiled})
  endif()
endfunction()

# pprt_compile_as(ROOM a.cpp ...): in a unity build of this module, one translation unit for these sources. scripts/rooms.awk
# finds by its name what a room costs. Sources of such a module that are not named are compiled alone.
function(pprt_compile_as room)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${room})
endfunction()

# pprt_program(NAME MAIN_SOURCE MODULE): a program that is installed.
function(pprt_program name source module)
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE ${module} CLI11::CLI11)
  target_compile_options(${name} PRIVATE ${PPRT_COLD_FLAGS})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  install(TARGETS ${name})
endfunction()

# pprt_unit_test(NAME [OWN_FLAGS] [COMPUTES] [REAL_TIME [ALONE]] SOURCES a.cpp ... USES modules ... LABELS labels ...):
# a Catch2 program, one CTest entry a case. With COMPUTES its own code takes so long that optimising it pays. With
# REAL_TIME its cases tagged [realtime], whose outcome needs a machine that keeps up, get the label "realtime" instead.
# They run one at a time, and the others give way (tests/CMakeLists.txt). With ALONE those tagged [alone], too, run beside
# no other.
function(pprt_unit_test name)
  cmake_parse_arguments(T "OWN_FLAGS;COMPUTES;REAL_TIME;ALONE" "" "SOURCES;USES;LABELS" ${ARGN})
  if(NOT T_LABELS)
    set(T_LABELS unit)
  endif()
  add_executable(test_${name} ${T_SOURCES})
  # In a unity build: each unit reads the same headers anew, and the tests' sources are small.
  set_target_properties(test_${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 32)
  target_link_libraries(test_${name} PRIVATE ${T_USES} pprt_flags Catch2::Catch2WithMain)
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  set(flags ${PPRT_TEST_FLAGS})
  if(T_COMPUTES)
    set(flags ${PPRT_COLD_FLAGS})
  endif()
  target_compile_options(test_${name} PRIVATE ${flags})
  if(Catch2_VERSION VERSION_GREATER_EQUAL 3)
    target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/catch2_3)
  endif()
  if(PPRT_PCH AND NOT T_OWN_FLAGS AND NOT T_COMPUTES)
    target_precompile_headers(test_${name} REUSE_FROM pprt_test_pch)
  endif()
  # What stands before the program in CTest's commands, for the calls that follow.
  set(beside ${PPRT_BESIDE} ${CMAKE_CROSSCOMPILING_EMULATOR})
  set_target_properties(test_${name} PROPERTIES CROSSCOMPILING_EMULATOR "${beside}")
  catch_discover_tests(test_${name} TEST_SPEC "~[realtime]~[.]" TEST_PREFIX "${name}: "
                       PROPERTIES LABELS "${T_LABELS}" TIMEOUT 300)
  if(T_REAL_TIME)
    set_target_properties(test_${name} PROPERTIES CROSSCOMPILING_EMULATOR "${CMAKE_CROSSCOMPILING_EMULATOR}")
    set(those "[realtime]")
    if(T_ALONE)
      set(those "[realtime]~[alone]")
    endif()
    catch_discover_tests(test_${name} TEST_SPEC "${those}" TEST_LIST test_${name}_realtime
                         TEST_PREFIX "${name}, real time: " PROPERTIES LABELS realtime TIMEOUT 300 ${PPRT_REAL_TIME})
  endif()
  if(T_ALONE)
    catch_discover_tests(test_${name} TEST_SPEC "[realtime][alone]" TEST_LIST test_${name}_alone
                         TEST_PREFIX "${name}, real time: " PROPERTIES LABELS realtime TIMEOUT 300 RUN_SERIAL ON)
  endif()
  add_dependencies(unit_tests test_${name})
endfunction()
