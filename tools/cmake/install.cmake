# SPDX-License-Identifier: Apache-2.0
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME chromeball)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/chromeball)
install(TARGETS chromeball_renderer EXPORT chromeball-targets
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS chromeball_imageio LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT tiff)
install(DIRECTORY ${chromeball_include_dir}/chromeball TYPE INCLUDE)
install(EXPORT chromeball-targets NAMESPACE chromeball:: DESTINATION ${package_dir})

get_target_property(library_type chromeball_renderer TYPE)
configure_package_config_file(tools/cmake/chromeball-config.cmake.in
                              ${PROJECT_BINARY_DIR}/chromeball-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/chromeball-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/chromeball-config.cmake
              ${PROJECT_BINARY_DIR}/chromeball-config-version.cmake
        DESTINATION ${package_dir})

if(TARGET chromeball)
  # Where the command finds a shared libchromeball, relative to itself.
  set_target_properties(chromeball PROPERTIES INSTALL_RPATH "$ORIGIN/${bin_to_lib}")
  install(TARGETS chromeball)
  install(FILES docs/chromeball.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES tools/completion/chromeball.bash RENAME chromeball
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES tools/completion/_chromeball
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES tools/completion/_chromeball  # the folder of packages, in Debian
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
  install(FILES tools/completion/chromeball.fish
          DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
  # For a first picture.
  install(FILES scenes/models/still-life.glb probes/dusk.exr DESTINATION ${CMAKE_INSTALL_DATADIR}/chromeball)
endif()
install(FILES LICENSE TYPE DOC)
if(PROJECT_IS_TOP_LEVEL)
  include(tools/cmake/package.cmake)
endif()
