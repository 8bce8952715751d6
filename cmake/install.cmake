# `cmake --install build`: program, scenarios, manual pages, the rooms as a CMake package, the Python package. `cpack` in the
# build folder makes Debian packages of the same parts.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/twinbench)

install(TARGETS twinbench RUNTIME COMPONENT program)
install(DIRECTORY scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/twinbench COMPONENT program)
install(FILES README.md CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
# What the program itself prints: manual pages (help2man, if it is there) and the words of the shell.
install(CODE "execute_process(
  COMMAND ${PROJECT_SOURCE_DIR}/tools/program_pages $<TARGET_FILE:twinbench> ${PROJECT_VERSION}
    \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1
    \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}
  COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)

# The rooms: find_package(twinbench), twinbench::benches and what it needs.
get_property(rooms GLOBAL PROPERTY TWINBENCH_ROOMS)
install(TARGETS ${rooms} twinbench_asio EXPORT twinbench ARCHIVE COMPONENT development)
install(DIRECTORY optics mechanics twin hw_bridge DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/twinbench COMPONENT development
  FILES_MATCHING PATTERN *.h)
install(EXPORT twinbench NAMESPACE twinbench:: DESTINATION ${package_dir} FILE twinbench-targets.cmake COMPONENT development)
configure_package_config_file(cmake/twinbench-config.cmake.in ${CMAKE_BINARY_DIR}/twinbench-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/twinbench-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/twinbench-config.cmake ${CMAKE_BINARY_DIR}/twinbench-config-version.cmake
  DESTINATION ${package_dir} COMPONENT development)

if(TARGET twinbench_python)
  install(TARGETS twinbench_python LIBRARY DESTINATION lib/python3/dist-packages/twinbench COMPONENT python)
  install(DIRECTORY tools/python/twinbench DESTINATION lib/python3/dist-packages COMPONENT python
    PATTERN __pycache__ EXCLUDE)
  install(DIRECTORY scenarios DESTINATION lib/python3/dist-packages/twinbench COMPONENT python)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the twinbench developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "virtual test bench for precision rotary tables")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program development)
if(TARGET twinbench_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME twinbench)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtwinbench-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libbullet-dev, libembree-dev, libopenexr-dev, libtomlplusplus-dev, libfmt-dev, libsqlite3-dev, libssl-dev, nlohmann-json3-dev, libceres-dev, libpugixml-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-twinbench)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
include(CPack)
