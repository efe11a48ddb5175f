# vcpkg port of OpenGV, which vcpkg lacks: the commit that Debian 12 packages.
vcpkg_from_git(
  OUT_SOURCE_PATH SOURCE_PATH
  URL https://github.com/laurentkneip/opengv.git
  REF 91f4b19c73450833a40e463ad3648aae80b3a7f3
)

# Eigen's types in the interface change their alignment with -march=native.
vcpkg_replace_string("${SOURCE_PATH}/CMakeLists.txt" "-march=native" "-march=x86-64")
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    -DCMAKE_POLICY_VERSION_MINIMUM=3.5
    "-DEIGEN_INCLUDE_DIR=${CURRENT_INSTALLED_DIR}/include/eigen3"
    -DBUILD_TESTS=OFF
    -DBUILD_PYTHON=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/opengv-1.0)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/License.txt")
