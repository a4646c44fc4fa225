// Points in time as texts in results: ISO 8601, UTC.
#pragma once

#include <string>

namespace scree {

std::string utc_now();  // "2026-11-25T18:34:06Z"
// Time since then by this machine's clock [s]; negative if the other machine's clock is ahead. NaN for a text
// that is not from utc_now().
double seconds_since(const std::string& utc);

}  // namespace scree
