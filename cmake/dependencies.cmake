# Every third-party library, found once. Which module may see which is said by its own CMakeLists.txt.
find_package(Threads REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
# Debian 12's Imath names a library for Python that another package has. That does not matter here, but is told in ten lines.
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(Imath REQUIRED)
find_package(OpenEXR REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(libjpeg-turbo CONFIG REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(pegtl REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED)
endif()
find_package(assimp REQUIRED)
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)  # all in its header
find_package(MPI REQUIRED COMPONENTS C)

# Boost brings CMake files of its own; CMake 3.30 and later warn where nobody says that CGAL is to take these.
set(CMAKE_POLICY_DEFAULT_CMP0167 NEW)
# CGAL reports its own build type advice; ours is set already.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL REQUIRED)
find_package(Boost CONFIG REQUIRED)

if(BUILD_TESTING)
  find_package(Catch2 REQUIRED)
endif()
if(PPRT_BENCH)
  find_package(benchmark REQUIRED)
endif()
