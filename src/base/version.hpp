// Version and build of the program; the build generates the source file.
#pragma once

#include <string>

namespace scree {

std::string version();        // e.g. "0.1.0"
std::string commit();         // of the source tree, with "-modified" if files differ; "unknown" outside git
std::string compiler();       // of C++, e.g. "GNU 12.2.0"
std::string compile_flags();  // e.g. "Release: -O3 -DNDEBUG"

}  // namespace scree
