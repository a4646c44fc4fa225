#include "run/check/start_picture.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>

#include "base/error.hpp"
#include "base/log.hpp"
#include "dem/particles/particle_store.hpp"
#include "output/run_record.hpp"
#include "run/loop/choose_backend.hpp"
#include "run/record/recorder.hpp"
#include "run/report/scree_post.hpp"
#include "run/report/signals.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

// A new folder beside a file, visible to all ranks and removed by the destructor. Every rank knows its path.
class TemporaryFolder {
 public:
  TemporaryFolder(const std::string& file, const Ranks& ranks) : ranks_(ranks) {
    const fs::path parent = fs::path(file).parent_path();
    path_ = ((parent.empty() ? "." : parent) / ".scree_picture_XXXXXX").string();
    ranks.on_root([&] {
      if (mkdtemp(path_.data()) == nullptr)
        throw IoError(fmt::format("{}: cannot create a folder beside it: {}", file, std::strerror(errno)));
    });
    ranks.broadcast(std::span(path_));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (ranks_.is_root()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  const Ranks& ranks_;
  std::string path_;
};

// The fields that pictures need.
Output output_of_start() {
  Output output;
  output.fields = {"radius", "velocity"};
  return output;
}

// Writes the start as a run does.
void write_start(const Model& model, const std::string& folder, const Ranks& ranks) {
  Log log(true);
  StageTimers timers;
  const std::unique_ptr<Backend> backend = choose_backend(model, ranks, "cpu", log);
  BodyCoupling link(model, ranks);
  CoupledStep step(model, *backend, link, timers);
  State state;
  state.clock = StepClock(model).state();
  backend->particles().load(initial_records(model.particles, Subdomain(model.space)), {});
  step.start(state.bodies);
  Recorder recorder(model, *backend, link, folder, state);
  {
    const Reports::Instant now(backend->reports());
    recorder.history(state, 0);
    recorder.snapshot(state);
  }
  recorder.finish();
}

}  // namespace

void draw_start(Model model, const std::string& resolved_deck, const std::string& program,
                const std::string& file, const Ranks& ranks) {
  catch_signals();  // so that a signal does not keep the folder from being removed
  model.output = output_of_start();
  const TemporaryFolder folder(file, ranks);
  write_start(model, folder.path(), ranks);
  if (ranks.max(signal_received()) != 0) return;
  ranks.on_root([&] {
    RunRecord record;
    record.resolved_deck = resolved_deck;
    write_run_record(folder.path(), record);
    run_scree_post(program, {"picture", folder.path(), "--output", file}, folder.path() + "/scree_post.log");
  });
}

}  // namespace scree
