# vcpkg port of the program, the C++ libraries and what the program reads. vcpkg has no OpenGV: its port is in opengv/.
# It needs a baseline of vcpkg with eigen3 3.4, because cmake/RcmeDependencies.cmake refuses Eigen 5.
#   vcpkg install rcme --overlay-ports=packaging/vcpkg --overlay-ports=packaging/vcpkg/opengv
# It builds the tree that it lies in. For a registry, replace the next line by vcpkg_from_github with REF and SHA512 of a release.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)

# Without HDF5, and so without the layout `posebench` of `rcme pairs`: only the library itself would be linked, not what a static
# one needs. OFF stops the search.
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    -DRCME_BUILD_TESTS=OFF
    -DRCME_BUILD_BENCHMARKS=OFF
    -DRCME_BUILD_PYTHON=OFF
    -DRCME_WARNINGS_AS_ERRORS=OFF
    -DRCME_HDF5_LIBRARY=OFF
    -DCMAKE_DISABLE_FIND_PACKAGE_PoseLib=ON
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/rcme)

# The program stays in bin: it finds its studies by the way from there to share/rcme.
set(VCPKG_POLICY_ALLOW_EXES_IN_BIN enabled)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/bin" "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/NOTICE")
