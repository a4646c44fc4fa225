// Makes every lock on a file fail as it does on a file system without locks; NO_LOCKS is the system's error
// number: 37 of NFS without lockd, 95 of Lustre mounted without flock, 524 of DVS.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static int refuse(void) {
  const char* error = getenv("NO_LOCKS");
  errno = error ? atoi(error) : ENOLCK;
  return -1;
}

static int locks(int command) {
  return command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK || command == F_OFD_SETLKW ||
         command == F_GETLK || command == F_OFD_GETLK;
}

int flock(int file, int operation) { return refuse(); }
int lockf(int file, int command, off_t length) { return refuse(); }
int lockf64(int file, int command, off64_t length) { return refuse(); }

static int pass_on(const char* name, int file, int command, void* argument) {
  int (*next)(int, int, ...) = (int (*)(int, int, ...))dlsym(RTLD_NEXT, name);
  return locks(command) ? refuse() : next(file, command, argument);
}

int fcntl(int file, int command, ...) {
  va_list list;
  va_start(list, command);
  void* argument = va_arg(list, void*);
  va_end(list);
  return pass_on("fcntl", file, command, argument);
}

int fcntl64(int file, int command, ...) {
  va_list list;
  va_start(list, command);
  void* argument = va_arg(list, void*);
  va_end(list);
  return pass_on("fcntl64", file, command, argument);
}
