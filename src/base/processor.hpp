// The instructions that the compiler was allowed to use, and whether this processor has them: the program
// ends with one line, and not with SIGILL, where it was built for a processor of another kind.
//
// The check runs before anything else of the program, static objects included, and its own code
// (processor.cpp) is compiled for every x86-64, whatever the rest is compiled for. It is linked into every
// program that asks for wanted_instructions().
#pragma once

namespace scree {

enum ProcessorRegister { kEax, kEbx, kEcx, kEdx };
// Registers that the operating system must keep for instructions that use them.
enum ProcessorState { kAlways, kYmm, kZmm };

// A set of instructions, and the bit that says of a processor that it has them.
struct ProcessorFeature {
  const char* name;  // nullptr ends a list
  unsigned leaf, subleaf;
  ProcessorRegister in;
  unsigned bit;
  ProcessorState state;
};

// Those that the build wants beyond what every x86-64 has, the newest first: constants, no code.
extern const ProcessorFeature kWantedFeatures[];

// The same list; empty where the build is for every processor.
const ProcessorFeature* wanted_instructions();

}  // namespace scree
