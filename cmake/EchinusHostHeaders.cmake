# Header-only libraries for a cross compiler that must not see the build machine's other headers: a folder of links to
# them alone, searched by find_path(), and modules for find_package().
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
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/host_headers)

# echinus_header_library(NAME): the target NAME with the folder of links.
function(echinus_header_library name)
  if(NOT TARGET ${name})
    add_library(${name} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${name} SYSTEM INTERFACE ${echinus_host_headers}/include)
  endif()
endfunction()
