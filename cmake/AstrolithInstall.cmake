# cmake --install gives programs, libraries, headers and a package:
#   find_package(astrolith REQUIRED)                        # evaluates recipes; needs none of the fitting packages
#   target_link_libraries(mine PRIVATE astrolith::synthesis)
#   find_package(astrolith REQUIRED COMPONENTS estimation)  # also fits them
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/astrolith)

get_property(libraries GLOBAL PROPERTY ASTROLITH_LIBRARIES)
set(core_libraries astrolith_compile_rules)
set(estimation_libraries)
foreach(library IN LISTS libraries)
  get_target_property(folder ${library} SOURCE_DIR)
  # Evaluating a recipe needs neither the fits nor the descriptors nor a GPU.
  if(folder MATCHES "^${PROJECT_SOURCE_DIR}/(estimation|cuda|descriptor/)")
    list(APPEND estimation_libraries ${library})
  else()
    list(APPEND core_libraries ${library})
  endif()
endforeach()

install(TARGETS ${core_libraries} EXPORT astrolithTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT astrolithTargets NAMESPACE astrolith:: DESTINATION ${package_folder})
set(header_folders numerics recipe geometry gravity descriptor synthesis)
if(ASTROLITH_ESTIMATION)
  install(TARGETS ${estimation_libraries} EXPORT astrolithEstimationTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT astrolithEstimationTargets NAMESPACE astrolith:: DESTINATION ${package_folder})
  list(APPEND header_folders estimation cuda)
endif()
foreach(folder IN LISTS header_folders)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/astrolith
    FILES_MATCHING PATTERN "*.h" PATTERN "*_internal.h" EXCLUDE)
endforeach()
install(FILES LICENSE recipe/recipe.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/astrolith)
# tasks/job/body_library.cpp finds the bodies beside the programs, in the folder of the build as in an installed prefix.
install(DIRECTORY library DESTINATION ${CMAKE_INSTALL_DATADIR}/astrolith COMPONENT programs)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/share/astrolith)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/library ${PROJECT_BINARY_DIR}/share/astrolith/library SYMBOLIC)
include(AstrolithManPages)
include(AstrolithPackage)

configure_package_config_file(cmake/astrolithConfig.cmake.in ${PROJECT_BINARY_DIR}/astrolithConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/astrolithConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/astrolithConfig.cmake ${PROJECT_BINARY_DIR}/astrolithConfigVersion.cmake
  DESTINATION ${package_folder})
