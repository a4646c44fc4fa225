// Points in time as texts of results: ISO 8601, UTC.
#pragma once

#include <string>

namespace scree {

std::string utc_now();  // "2026-11-25T18:34:06Z"
// How long ago that was, by this machine's clock [s]; below zero where another machine's clock is ahead. NaN
// where the text is none of utc_now().
double seconds_since(const std::string& utc);

}  // namespace scree
