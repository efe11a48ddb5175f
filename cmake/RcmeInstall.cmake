include(CMakePackageConfigHelpers)
set(RCME_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/rcme)
install(EXPORT rcmeTargets NAMESPACE rcme:: DESTINATION ${RCME_CMAKE_DIR})
configure_package_config_file(cmake/rcmeConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/rcmeConfig.cmake
                              INSTALL_DESTINATION ${RCME_CMAKE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/rcmeConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/rcmeConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/rcmeConfigVersion.cmake
              cmake/RcmeDependencies.cmake
        DESTINATION ${RCME_CMAKE_DIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR})
