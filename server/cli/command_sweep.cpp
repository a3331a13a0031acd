// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <numeric>
#include <sstream>

#include "cli/commands.h"
#include "cli/sweep_options.h"
#include "reports/console.h"
#include "sweep/folder.h"
#include "sweep/slurm.h"
#include "sweep/sweep.h"
#include "text/quoting.h"

namespace ziggurat::cli {
namespace {

void print_runs(const sweep::Experiment& experiment) {
  reports::Console console;
  std::string line = "run";
  for (const auto& axis : experiment.axes) line += "," + text::csv_field(axis.name);
  console.result(line + ",seed");
  for (std::size_t run = 1; run <= run_count(experiment); ++run) {
    const auto each = combination(experiment, run);
    line = fmt::format("{}", run);
    for (const auto& value : each.values) line += "," + text::csv_field(value);
    console.result(fmt::format("{},{}", line, each.seed));
  }
  console.flush();
}

/// The command that goes on with an interrupted sweep.
std::string resume_command(const SweepOptions& options) {
  const sweep::Settings& settings = options.settings;
  std::string command = fmt::format("ziggurat sweep resume {} --jobs {}",
                                    text::shell_word(options.out), settings.jobs);
  if (settings.timeout) command += fmt::format(" --timeout {}", *settings.timeout);
  if (settings.record == sweep::Record::failed) command += " --record failed";
  if (settings.record == sweep::Record::all) command += " --record all";
  if (options.retries_failed) command += " --retry-failed";
  return command;
}

int report(const SweepOptions& options, const sweep::Folder& folder, bool is_interrupted,
           reports::Console& console) {
  const auto results = folder.results();
  const auto failed = static_cast<std::size_t>(std::ranges::count_if(
      results, [](const auto& each) { return each.outcome != sweep::Outcome::finished; }));
  const std::size_t total = run_count(options.definition.experiment);
  if (is_interrupted) {
    console.report(fmt::format("interrupted: {} of {} runs are done; to go on: {}", results.size(),
                               total, resume_command(options)));
    return exit_code::interrupted;
  }
  console.report(fmt::format("{} runs: {} finished, {} failed{}; results: {}, {}", results.size(),
                             results.size() - failed, failed,
                             failed > 0 ? " (to run these again: --retry-failed)" : "",
                             folder.csv().string(), folder.ledger().string()));
  return failed > 0 ? exit_code::controller_failed : exit_code::finished;
}

void tell_warnings(const SweepOptions& options) {
  reports::Console console({options.quiet, false});
  for (const scene::Problem& warning : options.warnings) console.problem(warning);
}

int execute_local(const SweepOptions& options, processes::Signals& signals) {
  const sweep::Experiment& experiment = options.definition.experiment;
  reports::Console console({options.quiet, false});
  const sweep::Folder folder(options.out);
  folder.check(options.definition);  // before anything is written there
  std::filesystem::create_directories(folder.path());
  const sweep::Lock lock(folder.path() / "lock");
  folder.begin(options.definition);
  sweep::refuse_if_queued(folder);
  sweep::Ledger ledger(folder.ledger().string());
  const auto known = folder.results();
  std::vector<std::size_t> runs(run_count(experiment));
  std::iota(runs.begin(), runs.end(), std::size_t{1});
  const auto left = sweep::runs_to_do(runs, known, options.retries_failed);
  if (left.size() < runs.size()) {
    console.notice(
        fmt::format("{} of {} runs are done already", runs.size() - left.size(), runs.size()));
  }
  sweep::Sweep sweep(experiment, folder, options.settings, ledger, console, signals);
  const auto counts = sweep.execute(left);
  folder.write_csv(experiment, folder.results());
  ledger.make_view(experiment);
  const int code = report(options, folder, counts.is_interrupted, console);
  signals.completed(code);
  return code;
}

}  // namespace

std::string help_sweep() {
  std::ostringstream text;
  text << R"(usage: ziggurat sweep SCENE --out DIR [OPTION]... [-- OPTION-OF-RUN...]
       ziggurat sweep EXPERIMENT.toml [OPTION]...
       ziggurat sweep resume DIR [OPTION]...
       ziggurat sweep status DIR
       ziggurat sweep results DIR [--by AXIS]... [--metric NAME]... [--csv | --runs]
       ziggurat sweep plot DIR --y METRIC [--x AXIS] [--by AXIS] [--file FILE.svg]

Runs a scene with every combination of parameters and seeds, each in processes of its own, and keeps a
table of what came out (docs/experiments.md).

  ziggurat sweep swarm.argos --seeds 1..100 --param 'gain=0.5|1|2' --out results/
      300 runs, as many at a time as there are processors
  ziggurat sweep swarm.argos --seeds 1..10 --axis 'physics_engines/dynamics3d/@iterations=5|10' \
      --timeout 60 --record failed --out results/ -- --lua-processes 2
      what stands behind -- is for each 'ziggurat run'; {run} in it is the number of the run
  ziggurat sweep results results/ --by gain
      means with confidence intervals (Student's t), 95 % unless --confidence 0.99 says otherwise
  ziggurat sweep plot results/ --x gain --y time_to_aggregate
      the same as a picture

  ziggurat sweep swarm.argos --seeds 1..1000 --out results/ --slurm --partition short
      the same on a cluster; status, results and plot read it in the same way

DIR has sweep.sqlite and results.csv with a row per run: values, seed, outcome, exit code, metrics, hash of the
final state, wall time, version. A run is in the table when it is whole. Whatever was killed, the same command
or 'resume' goes on; only runs that were running are lost. Runs that failed leave runs/N/log.txt.

Exit codes: 0 all runs finished; 3 some failed; 1 fault of scene, arguments or environment; 130 interrupted.

)" << sweep_options();
  return text.str();
}

int execute_sweep(const Arguments& arguments, processes::Signals& signals) {
  const std::string verb = arguments.empty() ? "" : arguments.front();
  const Arguments rest(arguments.begin() + (arguments.empty() ? 0 : 1), arguments.end());
  if (verb == "status") return sweep_status(rest);
  if (verb == "results") return sweep_results(rest);
  if (verb == "plot") return sweep_plot(rest);
  if (verb == "task") return sweep_task(rest, signals);
  const SweepOptions options = verb == "resume" ? parse_resume(rest) : parse_sweep(arguments);
  tell_warnings(options);
  if (options.dry_run) {
    print_runs(options.definition.experiment);
    return exit_code::finished;
  }
  if (options.for_slurm || !options.kubernetes_file.empty()) return submit_sweep(options);
  return execute_local(options, signals);
}

}  // namespace ziggurat::cli
