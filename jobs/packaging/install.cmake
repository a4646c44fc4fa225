# cmake --install: the program, its manual page, and in share/scree what a user of it takes from this tree, in the same
# folders, so that the pages' links and commands hold there. Nothing knows where it is: the prefix may be moved afterwards.
include(GNUInstallDirs)
set(SCREE_SHARE ${CMAKE_INSTALL_DATADIR}/scree)

# Libraries from outside the system's folders are found where they were linked from.
if(NOT DEFINED CMAKE_INSTALL_RPATH_USE_LINK_PATH)
  set_target_properties(scree PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
endif()
install(TARGETS scree RUNTIME)

install(DIRECTORY ${CMAKE_SOURCE_DIR}/input DESTINATION ${SCREE_SHARE})
file(GLOB SCREE_JOBS CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/jobs/*.sbatch)
install(PROGRAMS ${SCREE_JOBS} ${CMAKE_SOURCE_DIR}/jobs/slurm_run.sh ${CMAKE_SOURCE_DIR}/jobs/mapping.sh
        DESTINATION ${SCREE_SHARE}/jobs)
file(GLOB SCREE_PAGES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/jobs/*.md)
install(FILES ${SCREE_PAGES} DESTINATION ${SCREE_SHARE}/jobs)
# As pip takes it; postprocess/scree-post is for the source tree, which has a .venv.
install(
  DIRECTORY ${CMAKE_SOURCE_DIR}/postprocess
  DESTINATION ${SCREE_SHARE}
  PATTERN __pycache__ EXCLUDE
  PATTERN .mypy_cache EXCLUDE
  PATTERN draw EXCLUDE
  PATTERN scree-post EXCLUDE
  PATTERN requirements.txt EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${CMAKE_SOURCE_DIR}/CITATION.cff
        DESTINATION ${SCREE_SHARE})
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE TYPE DOC)
install(
  FILES ${CMAKE_CURRENT_LIST_DIR}/modulefile
  DESTINATION ${SCREE_SHARE}/modulefiles/scree
  RENAME ${PROJECT_VERSION})

# The manual page is what the program says of itself: it is made when it is installed, by the program that is.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND AND NOT CMAKE_CROSSCOMPILING)
  set(SCREE_PAGE ${CMAKE_BINARY_DIR}/generated/scree.1)
  install(
    CODE "execute_process(
  COMMAND \"${Python3_EXECUTABLE}\" \"${CMAKE_CURRENT_LIST_DIR}/manual_page.py\" \"$<TARGET_FILE:scree>\" \"${SCREE_PAGE}\"
  COMMAND_ERROR_IS_FATAL ANY)")
  install(FILES ${SCREE_PAGE} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
else()
  message(STATUS "No Python here, or another machine's program: it is installed without a manual page")
endif()
