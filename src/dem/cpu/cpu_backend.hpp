// The serial backend of one rank: the paper's CMAP.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "dem/backend/backend.hpp"
#include "dem/cpu/cpu_explicit.hpp"
#include "dem/cpu/cpu_implicit.hpp"
#include "dem/cpu/cpu_particles.hpp"
#include "dem/cpu/cpu_reports.hpp"

namespace scree {

class CpuBackend : public Backend {
 public:
  explicit CpuBackend(const Model& model, const Ranks& ranks = {})
      : CpuBackend(model, ranks, make_contact_kernels(model.contact)) {}
  CpuBackend(const Model& model, const Ranks& ranks, std::unique_ptr<ContactKernels> law)
      : items_(model, ranks, std::move(law)), list_(items_), particles_(items_, list_), reports_(items_) {}

  std::string description() const override;
  RankParticles& particles() override { return particles_; }
  RankList& list() override { return list_; }
  Reports& reports() override { return reports_; }
  std::unique_ptr<ImplicitStep> open_step(Real h) override {
    return open_cpu_step(items_, implicit_arrays_, h);
  }
  std::unique_ptr<ExplicitRun> start_run(Real h) override {
    return std::make_unique<CpuExplicitRun>(items_, list_, h);
  }

 private:
  CpuItems items_;
  CpuList list_;
  CpuParticles particles_;
  CpuReports reports_;
  CpuImplicitArrays implicit_arrays_;
};

}  // namespace scree
