# The files that `cmake --install` installs, and the package for find_package(echinus): one component per
# library.
include(CMakePackageConfigHelpers)

set(echinus_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/echinus)
get_property(echinus_libraries GLOBAL PROPERTY ECHINUS_LIBRARIES)

# echinus_dependencies(TARGET OUT): the find_package() arguments of every package that users of the library
# must link too, one string each. Read from the target, so that the list stays complete; a static library
# passes on its private dependencies, a shared one does not.
function(echinus_dependencies target out)
  set(package_of_TBB::tbb "TBB")
  set(package_of_hwy::hwy "hwy")
  set(package_of_embree "embree 3")
  set(package_of_PNG::PNG "PNG")
  set(dependencies)
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  list(FILTER links EXCLUDE REGEX "BUILD_INTERFACE|::@|echinus|-NOTFOUND$")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link ${link})
    if(NOT DEFINED package_of_${link})
      message(FATAL_ERROR "${target} hands on ${link}: name its package in cmake/EchinusInstall.cmake")
    endif()
    list(APPEND dependencies ${package_of_${link}})
  endforeach()
  set(${out} ${dependencies} PARENT_SCOPE)
endfunction()

set(echinus_components)
set(echinus_component_dependencies)
foreach(target IN LISTS echinus_libraries)
  string(REPLACE "echinus_" "" component ${target})
  list(APPEND echinus_components ${component})
  echinus_dependencies(${target} dependencies)
  list(JOIN dependencies "\" \"" quoted)
  if(dependencies)
    string(APPEND echinus_component_dependencies "set(echinus_${component}_dependencies \"${quoted}\")\n")
  endif()
  # Relative to the library, so that the installed tree can be moved.
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS ${target} EXPORT ${target}_targets)
  install(EXPORT ${target}_targets NAMESPACE echinus:: DESTINATION ${echinus_package_dir})
endforeach()
if(TARGET echinus)
  file(RELATIVE_PATH library_dir ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(echinus PROPERTIES INSTALL_RPATH "$ORIGIN/${library_dir}")
endif()

# A header is installed only with its library.
set(header_folders ${PROJECT_SOURCE_DIR}/include/echinus)
foreach(component IN ITEMS scene render)
  if(component IN_LIST echinus_components)
    list(APPEND header_folders ${PROJECT_SOURCE_DIR}/include/echinus_${component})
  endif()
endforeach()
if(NOT io IN_LIST echinus_components)
  set(absent_header PATTERN mesh_io.hpp EXCLUDE)
endif()
install(DIRECTORY ${header_folders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN *.hpp PATTERN *.h ${absent_header})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/echinusConfig.cmake.in ${PROJECT_BINARY_DIR}/echinusConfig.cmake
  INSTALL_DESTINATION ${echinus_package_dir} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change declarations.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/echinusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/echinusConfig.cmake ${PROJECT_BINARY_DIR}/echinusConfigVersion.cmake
  DESTINATION ${echinus_package_dir})
