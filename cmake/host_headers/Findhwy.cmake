# Highway's library chooses among instruction sets at run time. WebAssembly has but one; for Windows a file of ours stands
# in for the library, of which Debian has none for that system.
echinus_header_library(hwy::hwy)
if(WIN32)
  target_sources(hwy::hwy INTERFACE ${CMAKE_CURRENT_LIST_DIR}/highway_targets.cpp)
endif()
set(hwy_FOUND TRUE)
