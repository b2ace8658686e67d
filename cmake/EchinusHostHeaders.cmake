# Header-only libraries for a cross compiler that must not see the build machine's other headers: a folder of links to
# them alone, searched by find_path(), and targets for find_package().
set(echinus_host_headers ${CMAKE_CURRENT_BINARY_DIR}/host_headers)
set(entries hwy flatbuffers nlohmann xxhash.h)
if(ECHINUS_BUILD_TOOLS)
  list(APPEND entries CLI fmt)
endif()
file(MAKE_DIRECTORY ${echinus_host_headers}/include)
foreach(entry IN LISTS entries)
  find_path(folder_of_${entry} ${entry} PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
  file(CREATE_LINK ${folder_of_${entry}}/${entry} ${echinus_host_headers}/include/${entry} SYMBOLIC)
endforeach()
list(APPEND CMAKE_FIND_ROOT_PATH ${echinus_host_headers})

# echinus_header_library(PACKAGE TARGET): the target with the folder of links; find_package(PACKAGE) finds it.
function(echinus_header_library package target)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${package}Config.cmake "")
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${echinus_host_headers}/include)
endfunction()
echinus_header_library(CLI11 CLI11::CLI11)
echinus_header_library(fmt fmt::fmt)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
echinus_header_library(nlohmann_json nlohmann_json::nlohmann_json)
# Highway's library chooses among instruction sets at run time. WebAssembly has but one; for Windows a file of ours stands
# in for the library, of which Debian has none for that system.
echinus_header_library(hwy hwy::hwy)
if(WIN32)
  target_sources(hwy::hwy INTERFACE ${CMAKE_CURRENT_LIST_DIR}/highway_targets.cpp)
endif()
# From the sources that Debian's libgtest-dev brings.
if(ECHINUS_BUILD_TESTS)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/GTestConfig.cmake "")
  set(BUILD_GMOCK OFF)
  set(INSTALL_GTEST OFF)
  add_subdirectory(/usr/src/googletest ${CMAKE_BINARY_DIR}/googletest EXCLUDE_FROM_ALL SYSTEM)
endif()
