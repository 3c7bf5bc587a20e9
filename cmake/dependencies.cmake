# Every third-party library, found once. Which module may see which is said by its own CMakeLists.txt.
find_package(Threads REQUIRED)
find_package(Imath REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(pegtl REQUIRED)
find_package(embree 3.13 REQUIRED)
find_package(assimp REQUIRED)
find_package(MPI REQUIRED COMPONENTS C)

# CGAL reports its own build type advice; ours is set already.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL REQUIRED)

if(BUILD_TESTING)
  find_package(Catch2 REQUIRED)
endif()
if(PPRT_BENCH)
  find_package(benchmark REQUIRED)
endif()
