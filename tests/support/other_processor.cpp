// A program built for instructions that no processor has, represented by a bit that is always zero. Its
// output besides the check of the processor shows whether anything ran before the check.
#include <cstdio>

#include "base/processor.hpp"

namespace {

struct SaysThatItRan {
  SaysThatItRan() { std::puts("a static object ran"); }
} early;

}  // namespace

namespace scree {

constinit const ProcessorFeature kWantedFeatures[] = {
    {"SSE2", 1, 0, kEdx, 26, kAlways},  // present in every x86-64
    {"THIS", 1, 0, kEdx, 10, kAlways},  // reserved, as the next one is
    {"THAT", 1, 0, kEdx, 20, kAlways},         {"VECTORS", 1, 0, kEdx, 10, kZmm},
    {"MORE", 0x7fffffff, 0, kEax, 0, kAlways},  // no processor has so many leaves
    {nullptr, 0, 0, kEax, 0, kAlways}};

}  // namespace scree

int main() { return scree::wanted_instructions() == nullptr; }
