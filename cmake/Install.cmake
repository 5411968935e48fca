# What `cmake --install` lays down, for find_package(ppscat) and for pkg-config.
# The program installs itself in cli/.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ppscat)

set_target_properties(ppscat_tree PROPERTIES EXPORT_NAME tree)
install(TARGETS ppscat ppscat_tree EXPORT ppscatTargets)
install(DIRECTORY include/ppscat TYPE INCLUDE FILES_MATCHING PATTERN "*.h")
install(DIRECTORY data/species data/scenes data/trees DESTINATION ${CMAKE_INSTALL_DATADIR}/ppscat)
install(EXPORT ppscatTargets NAMESPACE ppscat:: DESTINATION ${package_dir})

configure_package_config_file(cmake/ppscatConfig.cmake.in ppscatConfig.cmake
    INSTALL_DESTINATION ${package_dir}
    NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(ppscatConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES
    ${PROJECT_BINARY_DIR}/ppscatConfig.cmake
    ${PROJECT_BINARY_DIR}/ppscatConfigVersion.cmake
    DESTINATION ${package_dir})

file(RELATIVE_PATH pc_to_prefix
    ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/ppscat.pc.in ppscat.pc @ONLY)
configure_file(cmake/ppscat-tree.pc.in ppscat-tree.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/ppscat.pc ${PROJECT_BINARY_DIR}/ppscat-tree.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES README.md CHANGELOG.md LICENSE CITATION.cff TYPE DOC)
