// The program that draws: scree-post of the Python package in postprocess/.
#pragma once

#include <string>
#include <vector>

namespace scree {

// Its path: what the environment variable SCREE_POST names, or the first one on the PATH, or that of the
// source tree which this program was built in. Throws InputError where there is none.
std::string find_scree_post();
// Runs it with these words and waits for it; what it says goes into the file `log`. Where it fails, throws
// the last line of that: InputError where it was asked for what it cannot do, else IoError. A signal to this
// process (run/report/signals.hpp) ends it, too, which is no failure.
void run_scree_post(const std::string& program, const std::vector<std::string>& words,
                    const std::string& log);

}  // namespace scree
