# The settings of every target: the language, the warnings, and the arithmetic.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT EMSCRIPTEN) # whose modules are linked to one piece
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Kind of build" FORCE)
endif()

set(CMAKE_UNITY_BUILD_BATCH_SIZE 0) # where CMAKE_UNITY_BUILD is on, a target without groups is compiled as one

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND PROJECT_IS_TOP_LEVEL)
  # Without this, ccache caches nothing that is compiled with a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()

add_library(echinus_options INTERFACE)
target_compile_options(echinus_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough
  # GCC 12 warns about its own std::string when optimising, the more with precompiled headers: gcc.gnu.org/PR105651.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-stringop-overflow>
  # In a unity build every source counts as included, so that what is private to one looks shared.
  $<$<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>:-Wno-subobject-linkage>
  $<$<BOOL:${ECHINUS_WARNINGS_AS_ERRORS}>:-Werror>
  # The same bits on every machine: a fused multiply-add rounds once where the source rounds twice.
  -ffp-contract=off
  # No code reads errno after sqrt; without this, GCC calls the library instead of using the instruction.
  -fno-math-errno
  # No code traps on floating-point exceptions either; without this, GCC vectorises no loop with a division.
  # Neither flag changes a bit of a result.
  -fno-trapping-math
  # GCC 12 leaves out the rounding where neighbouring doubles are made floats and doubles again.
  $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
  # GCC believes that the stack of a 64-bit Windows is aligned for the widest vectors: gcc.gnu.org/PR54412. The assembler
  # makes all moves those that need no alignment.
  $<$<AND:$<BOOL:${MINGW}>,$<CXX_COMPILER_ID:GNU>>:-Wa,-muse-unaligned-vector-move>
  # Only there GCC 12 warns about its own std::string in this way.
  $<$<AND:$<BOOL:${MINGW}>,$<CXX_COMPILER_ID:GNU>>:-Wno-stringop-overread>)
if(ECHINUS_SANITIZE)
  target_compile_options(echinus_options INTERFACE
    -fsanitize=${ECHINUS_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # A float beyond the integer that it becomes: undefined as well, but not part of "undefined".
  if(ECHINUS_SANITIZE MATCHES "undefined")
    target_compile_options(echinus_options INTERFACE -fsanitize=float-cast-overflow)
  endif()
  # These take about a quarter of the time to compile a source, half of it pointer-overflow. The address sanitizer finds most
  # of what they would; what alignment and vptr alone would find, it does not.
  if(ECHINUS_SANITIZE MATCHES "address,undefined")
    target_compile_options(echinus_options INTERFACE -fno-sanitize=null,object-size,alignment,vptr,pointer-overflow)
  endif()
  target_link_options(echinus_options INTERFACE -fsanitize=${ECHINUS_SANITIZE})
endif()

# The headers that sources include most, and the given ones, compiled once for the target. Each source still names its own
# includes: the presets clang and wasm compile without. (The latter has sources that are optimised in another way.) None of
# the project's own: GCC tells a header that it has seen by its date, so that what ccache kept of a checkout does not fit
# the next one.
function(echinus_precompile target)
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <bit> <cmath> <cstddef> <cstdint> <functional> <limits>
    <memory> <optional> <span> <string> <string_view> <utility> <variant> <vector> ${ARGN})
endfunction()

# echinus_group_by_folder(SOURCES...): where CMAKE_UNITY_BUILD is on, sources of one folder are compiled as one, which takes
# half of the time. Kernels stay alone: Highway includes each once more for every set of instructions. So does what has
# options of its own. Kernels have many short-lived locals: if the address sanitizer also watches that none is used after
# its scope, they take three to six times as long to compile. For them GCC's -Wdangling-pointer has to do.
function(echinus_group_by_folder)
  foreach(source IN LISTS ARGN)
    file(STRINGS ${source} kernel REGEX "foreach_target" LIMIT_COUNT 1)
    if(NOT kernel)
      cmake_path(GET source PARENT_PATH folder)
      cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      string(MAKE_C_IDENTIFIER ${folder} group)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
    elseif(ECHINUS_SANITIZE MATCHES "address")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS -fno-sanitize-address-use-after-scope)
    endif()
  endforeach()
endfunction()

# echinus_add_folder(NAME FOLDER): every source in FOLDER and below becomes part of the library echinus_NAME.
function(echinus_add_folder name folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  target_sources(echinus_${name} PRIVATE ${sources})
  echinus_group_by_folder(${sources})
endfunction()

# echinus_add_library(NAME [SHARED]): the library target echinus_NAME with the alias echinus::NAME.
function(echinus_add_library name)
  add_library(echinus_${name} ${ARGN})
  add_library(echinus::${name} ALIAS echinus_${name})
  # Before 1.0 a minor version may change declarations, so it has its own soname.
  set_target_properties(echinus_${name} PROPERTIES EXPORT_NAME ${name} UNITY_BUILD_MODE GROUP
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_compile_features(echinus_${name} PUBLIC cxx_std_20)
  target_include_directories(echinus_${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(echinus_${name} PRIVATE $<BUILD_INTERFACE:echinus_options>)
  echinus_precompile(echinus_${name})
  set_property(GLOBAL APPEND PROPERTY ECHINUS_LIBRARIES echinus_${name})
endfunction()

# For all targets that compile kernels. SSSE3 without SSE4, and the additions of AVX3_DL to AVX-512, would
# have no users. SVE vectors have no fixed length and cannot be class members; Arm processors with SVE have
# NEON as well.
set(echinus_disabled_targets HWY_SSSE3 HWY_AVX3_DL HWY_SVE HWY_SVE2 HWY_SVE_256 HWY_SVE2_128)
if(ECHINUS_SANITIZE) # SSE2 and AVX2 see what the others would, and kernels take longest to compile
  list(APPEND echinus_disabled_targets HWY_SSE4 HWY_AVX3)
endif()
list(JOIN echinus_disabled_targets "|" echinus_disabled_targets)
set(ECHINUS_HIGHWAY_TARGETS "HWY_DISABLED_TARGETS=(${echinus_disabled_targets})")
