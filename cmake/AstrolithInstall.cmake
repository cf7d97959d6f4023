# cmake --install gives programs, libraries, headers and a package:
#   find_package(astrolith REQUIRED)
#   target_link_libraries(mine PRIVATE astrolith::synthesis)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY ASTROLITH_LIBRARIES)
install(TARGETS ${libraries} astrolith_compile_rules EXPORT astrolithTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT astrolithTargets NAMESPACE astrolith:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/astrolith)
foreach(folder numerics recipe geometry descriptor synthesis)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/astrolith
    FILES_MATCHING PATTERN "*.h" PATTERN "*_internal.h" EXCLUDE)
endforeach()
if(ASTROLITH_ESTIMATION)
  install(DIRECTORY estimation DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/astrolith
    FILES_MATCHING PATTERN "*.h" PATTERN "*_internal.h" EXCLUDE)
endif()
install(FILES recipe/recipe.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/astrolith)
configure_package_config_file(cmake/astrolithConfig.cmake.in ${PROJECT_BINARY_DIR}/astrolithConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/astrolith)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/astrolithConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/astrolithConfig.cmake ${PROJECT_BINARY_DIR}/astrolithConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/astrolith)
