# SPDX-License-Identifier: Apache-2.0
# `cpack` in the build folder makes package/chromeball_VERSION_amd64.deb and package/chromeball-tiff_VERSION_amd64.deb.
# The latter is the module alone: OpenImageIO depends on 230 packages of 660 MB, the former on 20 of 63 MB.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/package)
set(CPACK_PACKAGE_CONTACT "Chromeball maintainers <maintainers@chromeball.invalid>")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL chromeball tiff)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_CHROMEBALL_DESCRIPTION "renderer of glTF scenes lit by HDR light probes
Path tracer for image-based lighting, whose pictures are verified to be
correct: probes from photographs, compositing into photographs, baking,
comparison of the published methods of sampling a probe.
.
The command needs a processor with AVX2. TIFF files need the package
chromeball-tiff; the static library in this package needs those packages of
its suggestions that end in -dev, and pkg-config.")
set(CPACK_DEBIAN_CHROMEBALL_PACKAGE_NAME chromeball)
string(JOIN ", " CPACK_DEBIAN_CHROMEBALL_PACKAGE_SUGGESTS "chromeball-tiff (= ${PROJECT_VERSION})"
       libblosc-dev libdraco-dev libembree-dev libfmt-dev libglm-dev libjpeg-dev libmeshoptimizer-dev
       libopenexr-dev libpng-dev libtbb-dev libtinygltf-dev libwebp-dev pkg-config)
set(CPACK_COMPONENT_TIFF_DESCRIPTION "module of chromeball that reads TIFF files
Loaded by the command chromeball for the first TIFF file that it reads, by
way of OpenImageIO.")
set(CPACK_DEBIAN_TIFF_PACKAGE_NAME chromeball-tiff)
set(CPACK_DEBIAN_TIFF_PACKAGE_DEPENDS "chromeball (= ${PROJECT_VERSION})")

set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # cpack does not build tests and benchmarks
include(CPack)
