// Runs scree-post of the Python package in postprocess/, which draws pictures.
#pragma once

#include <string>
#include <vector>

namespace scree {

// Path of scree-post: the value of the environment variable SCREE_POST, or the first one on the PATH, or that
// in the source tree of this build. Throws InputError if there is none.
std::string find_scree_post();
// Runs the program with these arguments and waits for it; its output goes into the file `log`. A failure
// throws the last line of the output: InputError if the request cannot be fulfilled, else IoError. A signal
// to this process (run/report/signals.hpp) also ends the program, and does not count as a failure.
void run_scree_post(const std::string& program, const std::vector<std::string>& options,
                    const std::string& log);

}  // namespace scree
