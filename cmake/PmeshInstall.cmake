# `cmake --install`: the program, the libraries with their headers, and a CMake package, so that
# find_package(pmesh) gives pmesh::refine, pmesh::core, pmesh::protocol, pmesh::server and
# pmesh::client.

include(CMakePackageConfigHelpers)

set(pmesh_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pmesh)

install(TARGETS pmesh)
install(TARGETS pmesh_settings pmesh_asio pmesh_refine pmesh_core pmesh_protocol pmesh_server
  pmesh_client EXPORT pmeshTargets)
install(DIRECTORY core protocol server client
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pmesh FILES_MATCHING PATTERN "*.h")

install(EXPORT pmeshTargets NAMESPACE pmesh:: DESTINATION ${pmesh_package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/pmeshConfig.cmake.in
  ${PROJECT_BINARY_DIR}/pmeshConfig.cmake INSTALL_DESTINATION ${pmesh_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pmeshConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pmeshConfig.cmake ${PROJECT_BINARY_DIR}/pmeshConfigVersion.cmake
  DESTINATION ${pmesh_package_dir})
