// Speed of explicit and implicit steps on settled beds, and the additional cost of bodies. Usage: bed
// --help.  The CPU's times are CPU seconds. The GPU's, and those of several ranks of mpirun, are wall
// seconds around batches of steps that return when the work is done, launches and waiting included; of ranks
// the longest.
#include <fmt/format.h>
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>

#include "base/error.hpp"
#include "base/version.hpp"
#include "bed_cases.hpp"
#include "bed_run.hpp"
#include "bed_spread.hpp"
#include "dem/backend/device.hpp"
#include "mbs/petsc_session.hpp"
#include "partition/shared_model.hpp"
#include "support/measured.hpp"

namespace scree {
namespace {

// Bodies and particles exchange in batches of this many steps: as long as those between two outputs of a
// run.
constexpr Index kCoupledBatch = 1000;
// Implicit steps of the bed before anything is measured: the contacts adapt to the longer step.
constexpr int kImplicitWarmUp = 5;

void print_contacts(const Samples& samples, std::int64_t contacts, Backend& backend) {
  fmt::print("{:10} {} contacts, {:.4g} ns per contact and step, {} ghosts of the first rank\n", "", contacts,
             1e9 * samples.median() / static_cast<double>(contacts), backend.list().balance().halo.ghosts);
}

void measure_explicit(Model bed, Real h, const Options& options, BedReport& report) {
  bed.integrator.particles = ParticleIntegrator::velocity_verlet;
  // How often particles outside the domain are searched.
  bed.integrator.substeps = bed.space.dimension == 3 ? 25 : 10;
  Run run(std::move(bed), options);
  Backend& backend = *run.backend;
  const Real skin = run.model.contact.skin;
  backend.list().set_body_motion({});
  backend.list().build(skin, run.timers);
  backend.particles().initial_forces();
  const std::int64_t contacts = options.spread > 0 ? backend.reports().ledger(0).contacts : 0;
  const std::unique_ptr<ExplicitRun> bed_run = backend.start_run(h);
  const auto take = [&](Index steps) {
    if (bed_run->take_steps(steps, true, run.timers).closed != steps)
      throw SimulationError("a particle has left the bed");
  };
  std::int64_t builds = 0;
  StageTimers timers;
  const Samples samples = sample(
      options, options.rebuild > 0 ? options.rebuild : run.model.integrator.substeps,
      [&](Index steps) {
        if (options.rebuild == 0) take(steps);
        for (Index done = 0; options.rebuild > 0 && done < steps; done += options.rebuild) {
          take(options.rebuild);
          backend.list().build(skin, run.timers);
        }
        backend.list().displacement();  // returns when all queued work is done
      },
      [&] { builds = backend.list().builds(), timers = run.timers; });
  builds = backend.list().builds() - builds;
  fmt::print("{:10d} {}, {} x {} steps, {} list builds, {:.2f} listed per particle\n",
             run.model.particles.totals.count, speed_text(samples, run.model.particles.totals.count),
             options.repeats, samples.steps, builds, run.listed());
  print_device_memory(backend);
  if (options.spread > 0) {
    print_contacts(samples, contacts, backend);
    print_stages(timers, run.timers, static_cast<double>(samples.steps) * options.repeats);
  }
  report.add(measured(samples, run.model, builds), timers, run.timers, backend);
}

void measure_implicit(Model bed, const Options& options, BedReport& report) {
  const Real h = implicit_sphere_step(bed);
  Run run(std::move(bed), options);
  run.step.start(run.bodies);
  Index taken = 0;
  const auto advance = [&](Index steps) {
    for (Index k = 0; k < steps; ++k) {
      const StepOutcome outcome = run.step.implicit_step(run.bodies, static_cast<Real>(taken++) * h, h);
      if (outcome.verdict != Verdict::accepted) throw SimulationError(outcome.trouble);
    }
  };
  advance(kImplicitWarmUp);
  StageTimers timers;
  StepCounts counts;
  std::int64_t builds = 0;
  const Samples samples = sample(options, 1, advance, [&] {
    timers = run.timers, counts = run.step.counts(), builds = run.backend->list().builds();
  });
  builds = run.backend->list().builds() - builds;
  const double steps = static_cast<double>(run.step.counts().steps - counts.steps);
  fmt::print(
      "{:10d} {:.4g} ({:.4g} to {:.4g}) ms per step, {:.1f} Newton and {:.1f} linear iterations per step, {} "
      "x {} "
      "steps, {} list builds, {:.2f} listed per particle\n",
      run.model.particles.totals.count, 1e3 * samples.median(), 1e3 * samples.seconds.front(),
      1e3 * samples.seconds.back(),
      static_cast<double>(run.step.counts().newton_iterations - counts.newton_iterations) / steps,
      static_cast<double>(run.step.counts().linear_iterations - counts.linear_iterations) / steps,
      options.repeats, samples.steps, builds, run.listed());
  print_stages(timers, run.timers, steps);
  Measured result = measured(samples, run.model, builds);
  result.newton = static_cast<double>(run.step.counts().newton_iterations - counts.newton_iterations) / steps;
  result.linear = static_cast<double>(run.step.counts().linear_iterations - counts.linear_iterations) / steps;
  report.add(result, timers, run.timers, *run.backend);
}

struct CoupledSamples {
  Samples samples;
  double iterations = 0;      // Newton iterations of the bodies per step
  std::vector<int> contacts;  // of the bodies' shapes, after each batch of the samples
  StageTimers timers;         // of all steps
  double steps = 0;

  int least_contacts() const { return *std::min_element(contacts.begin(), contacts.end()); }
  double mean_contacts() const {
    return std::accumulate(contacts.begin(), contacts.end(), 0.0) / static_cast<double>(contacts.size());
  }
};

// Variants of a bed: complete, or with a hole or bodies in a part of it.
struct BedPart {
  std::string name;
  std::int64_t whole;  // particles of the plain bed
};

// The coupled explicit step, with bodies solved every step where the bed has some.
CoupledSamples sample_coupled(Model bed, const BedPart& part, const Options& options, BedReport& report) {
  bed.integrator.particles = ParticleIntegrator::velocity_verlet;
  Run run(std::move(bed), options);
  run.step.start(run.bodies);
  Index taken = 0;
  CoupledSamples out;
  std::int64_t builds = 0;
  StageTimers timers;
  const auto advance = [&](Index steps) {
    for (Index done = 0; done < steps; done += kCoupledBatch) {
      std::vector<Real> times;
      for (Index k = 0; k < kCoupledBatch; ++k) times.push_back(static_cast<Real>(taken++) * kSphereStep);
      if (options.plough && run.link.has_bodies() && times.back() > run.model.time.end)
        throw InputError(
            "--plough: it has come through the bed; fewer --repeats, --seconds or --steps, or more "
            "--particles");
      if (run.step.explicit_steps(run.bodies, times, kSphereStep, times.back() + kSphereStep) != times.size())
        throw SimulationError("a particle has left the bed");
      const std::vector<int> contacts = run.backend->reports().pack_shapes().contacts;
      out.contacts.push_back(std::accumulate(contacts.begin(), contacts.end(), 0));
    }
    run.backend->list().displacement();
  };
  out.samples = sample(options, kCoupledBatch, advance, [&] {
    builds = run.backend->list().builds(), timers = run.timers;
    out.contacts.clear();
  });
  builds = run.backend->list().builds() - builds;
  Measured result = measured(out.samples, run.model, builds);
  result.contacts = out.mean_contacts(), result.bed = part.name, result.size = part.whole;
  report.add(result, timers, run.timers, *run.backend);
  const StepCounts& counts = run.step.counts();
  out.iterations = static_cast<double>(counts.newton_iterations) / static_cast<double>(counts.steps);
  out.timers = run.timers, out.steps = static_cast<double>(counts.steps);
  return out;
}

// The bed alone, without the particles at the bodies' positions, and with the bodies: the same steps.
void measure_bodies(Model bed, const Options& options, BedReport& report) {
  const std::int64_t whole = bed.particles.totals.count;
  const Samples plain = sample_coupled(bed, {"plain", whole}, options, report).samples;
  options.net ? add_net(bed) : add_plough(bed);
  const std::int64_t particles = bed.particles.totals.count;
  const std::size_t bodies = bed.bodies.size();
  Model bare = bed;
  bare.bodies.clear(), bare.joints.clear(), bare.drivers.clear(), bare.spring_dampers.clear();
  bare.applied_forces.clear();
  const Samples without = sample_coupled(std::move(bare), {"with a hole", whole}, options, report).samples;
  const std::string row = options.net ? "with a net" : "with a row drawn through it";
  const CoupledSamples with = sample_coupled(std::move(bed), {row, whole}, options, report);
  fmt::print("{:10d} the plain bed: {}\n", whole, speed_text(plain, whole));
  fmt::print("{:10d} without bodies, in their place a hole: {}\n", particles, speed_text(without, particles));
  fmt::print(
      "{:10} with {} bodies: {}; {:.1f} iterations of the bodies per step, {:.1f} contacts of theirs (at "
      "least {})\n",
      "", bodies, speed_text(with.samples, particles), with.iterations, with.mean_contacts(),
      with.least_contacts());
  for (const auto& [name, other] : {std::pair("the hole", without), std::pair("the plain bed", plain)})
    fmt::print("{:10} {:.4g} times as long as {}, {:.4g} us more per step\n", "",
               with.samples.median() / other.median(), name, 1e6 * (with.samples.median() - other.median()));
  print_stages({}, with.timers, with.steps);
}

// "cuda, spheres, explicit, double, list every 25 steps, friction 0.5, 2 ranks"
std::string title_of(const Options& options) {
  const bool implicit = options.integrator == "hht";
  std::string title =
      fmt::format("{}, {}, {}, {}", options.backend, options.dimension == 3 ? "spheres" : "discs",
                  implicit ? "implicit" : "explicit", options.precision);
  if (options.spread > 0) title += fmt::format(", diameters 1 to {}, periodic", options.spread);
  if (!implicit && !options.with_bodies())
    title +=
        options.rebuild > 0 ? fmt::format(", list every {} steps", options.rebuild) : ", list where needed";
  title += contact_text(options.contact);
  if (!options.ranks.alone()) title += fmt::format(", {} ranks", options.ranks.size());
  if (options.wall && options.ranks.alone() && !options.on_gpu()) title += ", wall";
  return title + (options.per_rank ? ", per rank" : "");
}

void measure_all(const Options& options) {
  if (options.dimension == 2 && (options.with_bodies() || options.integrator == "hht"))
    throw InputError("--dimension 2: allowed for --integrator verlet without --net and --plough");
  if (options.with_bodies() && options.integrator == "hht")
    throw InputError("--net, --plough: allowed for --integrator verlet");
  if (options.precision == "mixed" && (!options.on_gpu() || options.integrator == "hht"))
    throw InputError("--precision mixed: allowed for --backend cuda with --integrator verlet");
  if (options.contact.rolling > 0 && !(options.contact.friction > 0))
    throw InputError("--rolling: needs --friction");
  if ((options.contact.rolling > 0 || options.contact.hertz) && options.integrator == "hht")
    throw InputError("--rolling, --hertz: allowed for --integrator verlet");
  if (options.spread > 0 && (options.dimension == 2 || options.integrator == "hht" || options.with_bodies()))
    throw InputError("--spread: allowed for --dimension 3 with --integrator verlet without bodies");
  if (options.contact.hertz && options.dimension == 2) throw InputError("--hertz: allowed for --dimension 3");
  if (options.on_gpu()) choose_device(options.ranks);
  if (options.on_gpu() && !device_error().empty()) throw InputError("--backend cuda: " + device_error());
  fmt::print("commit {}, {}, {}, {}{}{}{}\n", commit(),
             options.on_gpu()        ? device_name() + ", wall seconds around synchronised batches"
             : options.ranks.alone() ? options.wall ? "one core, wall seconds" : "one core, CPU seconds"
                                     : fmt::format("{} ranks, wall seconds", options.ranks.size()),
             options.precision, options.dimension == 3 ? "spheres" : "discs",
             options.integrator == "hht" ? ", implicit" : ", explicit", contact_text(options.contact),
             options.integrator == "hht" || options.with_bodies() ? ""
             : options.rebuild > 0 ? fmt::format(", list rebuild every {} steps included", options.rebuild)
                                   : ", list rebuilds where needed");
  if (options.on_gpu()) measured_on_gpu(device_name());
  if (!options.ranks.alone()) measured_on_ranks(options.ranks.size());
  const std::string rebuild = options.with_bodies()         ? "coupled"
                              : options.integrator == "hht" ? "0"
                                                            : fmt::format("{}", options.rebuild);
  BedReport report(
      options.csv,
      fmt::format("{},\"{}\",{},{},{},{},{},{}", commit(),
                  options.on_gpu() ? device_name() : processor_name(), options.backend, options.precision,
                  options.dimension, options.integrator, rebuild, options.contact.friction),
      title_of(options), options.ranks);
  // Bodies are positioned in the complete bed.
  const RankShare share(options.with_bodies() ? Ranks() : options.ranks);
  std::vector<Vec3> discs;
  if (options.dimension == 2) discs = settled_discs();
  for (const std::int64_t size : options.particles) {
    const std::int64_t particles = options.per_rank ? size * options.ranks.size() : size;
    Model bed = options.spread > 0       ? spread_box(options.spread, particles)
                : options.dimension == 3 ? sphere_bed(options.tile, particles, share)
                                         : disc_bed(discs, particles);
    set_contact(bed, options.contact, share);
    if (options.precision == "mixed") bed.integrator.precision = Precision::mixed;
    if (options.with_bodies())
      measure_bodies(std::move(bed), options, report);
    else if (options.integrator == "hht")
      measure_implicit(std::move(bed), options, report);
    else
      measure_explicit(std::move(bed), options.dimension == 3 ? kSphereStep : kDiscStep, options, report);
    std::fflush(stdout);
  }
}

ExitCode run(int count, char** values) {
  Options options;
  CLI::App app("Measures the speed of steps on settled beds", "bed");
  app.add_option("--dimension", options.dimension, "3: spheres, 2: discs (settled at the start)")
      ->check(CLI::IsMember({2, 3}));
  app.add_option("--backend", options.backend, "cpu or cuda")->check(CLI::IsMember({"cpu", "cuda"}));
  app.add_option("--precision", options.precision, "double or mixed")
      ->check(CLI::IsMember({"double", "mixed"}));
  app.add_option("--integrator", options.integrator, "verlet (explicit) or hht (implicit)")
      ->check(CLI::IsMember({"verlet", "hht"}));
  app.add_option("--particles", options.particles,
                 "sizes, multiples of 10000 (default: 10000 100000 1000000)");
  app.add_option("--spread", options.spread,
                 "compressed spheres in a periodic box, with diameters from 1 to this; 0: the settled bed")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--friction", options.contact.friction,
                 "coefficient of friction; 0: no friction and no rotation")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--rolling", options.contact.rolling,
                 "coefficient of rolling resistance; twisting is resisted with that of friction; 0: neither")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--hertz", options.contact.hertz, "Hertz' and Mindlin's laws in place of linear ones");
  app.add_option("--materials", options.contact.materials,
                 "number of materials, all alike: contacts look up the law of their pair")
      ->check(CLI::PositiveNumber);
  app.add_option("--rebuild", options.rebuild, "explicit steps per list rebuild; 0: the backend decides")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--repeats", options.repeats, "samples per size")->check(CLI::PositiveNumber);
  app.add_option("--seconds", options.seconds, "length of a sample, about")->check(CLI::NonNegativeNumber);
  app.add_option("--steps", options.steps, "least number of steps in a sample")
      ->check(CLI::NonNegativeNumber);
  CLI::Option* net =
      app.add_flag("--net", options.net, "the bed with a net of 20 bodies, solved every step, and without");
  app.add_flag("--plough", options.plough, "the same with a row of 20 bodies that is drawn through the bed")
      ->excludes(net);
  app.add_flag("--wall", options.wall, "wall seconds also on one core");
  app.add_flag("--per-rank", options.per_rank, "sizes are those of a rank's share, not of the bed");
  app.add_option("--tile", options.tile, "file with the tile of spheres");
  app.add_option("--csv", options.csv, "file that a row per size and rank is added to");
  try {
    app.parse(count, values);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::bad_input;
  }
  if (options.particles.empty()) options.particles = {10000, 100000, 1000000};
  if (!options.ranks.is_root() && std::freopen("/dev/null", "w", stdout) == nullptr)
    return ExitCode::io_failed;
  try {
    const PetscSession petsc("bed", {});
    measure_all(options);
  } catch (const InputError& error) {
    std::cerr << "error: " << error.what() << '\n';
    return ExitCode::bad_input;
  } catch (const IoError& error) {
    std::cerr << "error: " << error.what() << '\n';
    return ExitCode::io_failed;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return ExitCode::simulation_failed;
  }
  return ExitCode::done;
}

}  // namespace
}  // namespace scree

int main(int count, char** values) {
  MPI_Init(&count, &values);
  const scree::ExitCode code = scree::run(count, values);
  MPI_Finalize();
  return static_cast<int>(code);
}
