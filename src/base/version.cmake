# Run at every build: writes OUTPUT from version.cpp.in if the commit or the flags have changed since.
# -D SOURCE_DIR, OUTPUT, SCREE_VERSION, SCREE_COMPILER, SCREE_FLAGS
set(SCREE_COMMIT "unknown")
find_program(GIT_PROGRAM git)
if(GIT_PROGRAM)
  execute_process(
    COMMAND ${GIT_PROGRAM} -C ${SOURCE_DIR} describe --always --dirty=-modified --abbrev=12 --exclude=*
    OUTPUT_VARIABLE DESCRIPTION OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE FAILED)
  if(NOT FAILED)
    set(SCREE_COMMIT "${DESCRIPTION}")
  endif()
endif()
configure_file(${SOURCE_DIR}/src/base/version.cpp.in ${OUTPUT} @ONLY)
