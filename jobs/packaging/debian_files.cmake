# Run by cpack on what it has installed, before that becomes a package. Debian has places and names of its own for the
# licence and for what has changed, and modules for what is in /usr already would only be in the way.
if(NOT CPACK_GENERATOR STREQUAL DEB)
  return()
endif()
set(ROOT ${CPACK_TEMPORARY_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX})
set(DOC ${ROOT}/share/doc/${CPACK_PACKAGE_NAME})
file(REMOVE_RECURSE ${ROOT}/share/scree/modulefiles)
file(RENAME ${DOC}/LICENSE ${DOC}/copyright)
configure_file(${ROOT}/share/scree/CHANGELOG.md ${DOC}/changelog COPYONLY)
execute_process(COMMAND date -R OUTPUT_VARIABLE DATE OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${DOC}/changelog.Debian
     "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * As cpack makes it; what has changed is in changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${DATE}
")
execute_process(COMMAND gzip -9nf ${DOC}/changelog ${DOC}/changelog.Debian ${ROOT}/share/man/man1/scree.1
                COMMAND_ERROR_IS_FATAL ANY)
