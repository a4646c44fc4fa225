// Prints why this program cannot use the GPU. tests/CMakeLists.txt builds it for a generation older than any
// that Scree supports, so that there is a reason on every machine.
#include <cstdio>

#include "dem/backend/device.hpp"

int main() { std::puts(scree::device_error().c_str()); }
