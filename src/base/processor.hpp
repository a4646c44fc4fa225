// Instruction sets of the build, and whether this processor has them: on a processor of another kind the
// program ends with one line of explanation, and not with SIGILL.
//
// The check runs before all other code, including constructors of static objects, and is itself compiled for
// every x86-64 (processor.cpp). It is linked into every program that calls wanted_instructions().
#pragma once

namespace scree {

enum ProcessorRegister { kEax, kEbx, kEcx, kEdx };
// Register states that the operating system must save for an instruction set.
enum ProcessorState { kAlways, kYmm, kZmm };

// An instruction set, and the CPUID bit of processors that have it.
struct ProcessorFeature {
  const char* name;  // nullptr ends a list
  unsigned leaf, subleaf;
  ProcessorRegister in;
  unsigned bit;
  ProcessorState state;
};

// The instruction sets that the build requires beyond every x86-64, the newest first: constants without code.
extern const ProcessorFeature kWantedFeatures[];

// kWantedFeatures; empty if the build is for every processor.
const ProcessorFeature* wanted_instructions();

}  // namespace scree
