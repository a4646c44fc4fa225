# cpack in a build folder: a Debian package and a relocatable archive of what install.cmake installs. The preset "package"
# builds for any processor of the kind; a package of another build is for machines like this one alone.
set(CPACK_GENERATOR DEB TGZ)
set(CPACK_PACKAGE_VENDOR "The Scree developers")
# The maintainer of the package, not of Scree: whoever gives it to others, in dpkg's form.
set(CPACK_PACKAGE_CONTACT "Nobody <nobody@scree.invalid>" CACHE STRING "Who answers for the packages: Name <address>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "collisions between rigid bodies on joints and very many particles")
set(CPACK_PACKAGE_DESCRIPTION
    "Scree simulates a constrained multibody system (joints, motors, springs) and
very many particles that touch it and each other. A batch code: MPI ranks, TOML
input decks in, HDF5 for ParaView out.")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian_files.cmake)
set(CPACK_SYSTEM_NAME ${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})

# Libraries: whatever packages hold those that the program is linked to.
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS openmpi-bin)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "slurm-client, python3-venv, paraview")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
