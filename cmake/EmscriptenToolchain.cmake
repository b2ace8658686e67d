# Emscripten's own toolchain file, found through the compiler in PATH, and the flags of all the module's code.
find_program(EMCC_PROGRAM emcc NO_CMAKE_FIND_ROOT_PATH)
if(NOT EMCC_PROGRAM)
  message(FATAL_ERROR "emcc was not found; on Debian the package emscripten has it (scripts/setup)")
endif()
get_filename_component(emcc_file ${EMCC_PROGRAM} REALPATH)
get_filename_component(EMSCRIPTEN_ROOT_PATH ${emcc_file} DIRECTORY)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
set(ECHINUS_HOST_HEADERS ON)

# Native WebAssembly exceptions: without them, each call that might throw goes through JavaScript. 128-bit
# vectors, but not relaxed ones, whose results differ between machines.
set(CMAKE_CXX_FLAGS_INIT "-fwasm-exceptions -msimd128")
