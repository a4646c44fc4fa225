// A machine that forbids MPI: whoever starts it, a library included, ends the program.
#include <stdio.h>
#include <stdlib.h>

static int refuse(void) {
  fputs("MPI was started\n", stderr);
  exit(77);
}

int MPI_Init(int* count, char*** words) { return refuse(); }
int MPI_Init_thread(int* count, char*** words, int required, int* provided) { return refuse(); }
