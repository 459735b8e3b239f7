# Relocatable: find_package(crease CONFIG), components `runtime` (needs nothing) and `crease`, or
# pkg-config crease_runtime.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/crease)
# The viewer and the limit of memory come with the tool, and are no libraries that others link.
install(DIRECTORY include/crease DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  PATTERN viewer.h EXCLUDE PATTERN memory_limit.h EXCLUDE)
foreach(library IN ITEMS crease_runtime crease)
  if(TARGET ${library})
    install(TARGETS ${library} EXPORT ${library}-targets
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(EXPORT ${library}-targets NAMESPACE crease:: DESTINATION ${package_dir})
  endif()
endforeach()
if(TARGET crease_cli)
  install(TARGETS crease_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(cmake/crease-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/crease-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/crease-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/crease-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/crease-config-version.cmake
  cmake/dependencies.cmake
  DESTINATION ${package_dir})

# The prefix is told from where the .pc file lies, so that the tree can be moved.
file(RELATIVE_PATH pc_to_prefix
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/crease_runtime.pc.in ${CMAKE_CURRENT_BINARY_DIR}/crease_runtime.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crease_runtime.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
