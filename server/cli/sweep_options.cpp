// SPDX-License-Identifier: MIT
#include "cli/sweep_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <thread>
#include <utility>

#include "cli/arguments.h"
#include "cli/installed_scenes.h"
#include "cli/options.h"
#include "run/build.h"
#include "sweep/experiment_file.h"
#include "sweep/folder.h"
#include "sweep/scene_files.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;

constexpr unsigned help_width = 96;  // [characters]
constexpr unsigned most_jobs = 4096;
constexpr std::size_t most_run_arguments = 1000;

// Options of `run` that the sweep sets itself.
constexpr const char* own_options[] = {"seed", "set", "param", "summary", "record"};
// Options of `run` that two runs at a time can't both have.
constexpr const char* exclusive_options[] = {"endpoint",    "metrics",        "view", "hash-file",
                                             "trace",       "readings",       "rays", "images",
                                             "report-card", "snapshot-folder"};

auto text_value(const char* name) { return po::value<std::string>()->value_name(name); }
auto text_values(const char* name) {
  return po::value<std::vector<std::string>>()->composing()->value_name(name);
}

/// Splits the arguments at `--`; the second part is for `run`.
std::pair<Arguments, Arguments> split(const Arguments& arguments) {
  const auto end = std::ranges::find(arguments, "--");
  return {{arguments.begin(), end},
          {end == arguments.end() ? end : std::next(end), arguments.end()}};
}

void check_run_arguments(const std::vector<std::string>& arguments) {
  if (arguments.size() > most_run_arguments) {
    throw text::UsageError(fmt::format("there are {} options for runs; at most {} are taken",
                                       arguments.size(), most_run_arguments));
  }
  const GivenOptions given = read_given(arguments, run::by_run);
  const Parsed& parsed = given.own;
  const Values values(given.all), own(parsed.values);
  for (const char* name : own_options) {
    if (!values.has(name)) continue;
    throw text::UsageError(
        fmt::format("--{} is set by the sweep; write --seeds, --param, --axis or "
                    "--record before the '--' instead",
                    name));
  }
  if (!parsed.positional.empty()) {
    throw text::UsageError(
        fmt::format("'{}' behind '--' is no option of 'ziggurat run'", parsed.positional.front()));
  }
  for (const char* name : exclusive_options) {
    if (!values.has(name)) continue;
    if (!own.has(name)) {
      throw text::UsageError(fmt::format(
          "{} in the file of --settings would be the same for all runs; write --{} behind '--', "
          "with {{run}} in it, which becomes the number of the run",
          name, name));
    }
    const auto* one = boost::any_cast<std::string>(&parsed.values[name].value());
    for (const std::string& value : one ? std::vector{*one} : values.texts(name)) {
      if (value.find("{run}") != value.npos) continue;
      throw text::UsageError(
          fmt::format("--{0} '{1}' would be the same for all runs; write {{run}} in it, which "
                      "becomes the number "
                      "of the run",
                      name, value));
    }
  }
}

/// Options of the first run: its arguments are read as `ziggurat run` reads them.
/// @throws text::UsageError
run::Options options_of_first_run(const sweep::Experiment& experiment,
                                  const sweep::Settings& settings) {
  const auto command = run_command(experiment, combination(experiment, 1), settings.program, ".",
                                   settings.record != sweep::Record::none);
  return parse_options({command.begin() + 2, command.end()}, run::by_run);
}

sweep::Record to_record(const std::string& text) {
  if (text.empty()) return sweep::Record::none;
  if (text == "failed") return sweep::Record::failed;
  if (text == "all") return sweep::Record::all;
  throw text::UsageError(fmt::format("--record is '{}'; write failed or all", text));
}

unsigned to_jobs(const std::string& text) {
  const auto jobs = text::to_integer("--jobs", text);
  if (jobs == 0 || jobs > most_jobs) {
    throw text::UsageError(fmt::format("--jobs is {}; it must be from 1 to {}", jobs, most_jobs));
  }
  return static_cast<unsigned>(jobs);
}

double to_timeout(const std::string& text) {
  const double seconds = text::to_number("--timeout", text);
  if (seconds > 0) return seconds;
  throw text::UsageError(fmt::format("--timeout is {}; it must be above 0 seconds", text));
}

/// The command line wins over the file.
void read_settings(const Values& values, const sweep::ExperimentFile& file, SweepOptions& options) {
  sweep::Settings& settings = options.settings;
  settings.program = fs::read_symlink("/proc/self/exe").string();
  settings.version = run::version;
  settings.jobs =
      file.jobs.value_or(std::clamp(std::thread::hardware_concurrency(), 1u, most_jobs));
  settings.timeout = file.timeout;
  settings.record = to_record(file.record);
  if (values.has("jobs")) settings.jobs = to_jobs(values.text("jobs"));
  if (values.has("timeout")) settings.timeout = to_timeout(values.text("timeout"));
  if (values.has("record")) settings.record = to_record(values.text("record"));
  options.out = values.has("out") ? values.text("out") : file.out;
  options.retries_failed = values.has("retry-failed");
  options.dry_run = values.has("dry-run");
  options.quiet = values.has("quiet");
}

/// Reads the experiment from the options.
void read_experiment(const Values& values, const Arguments& for_run,
                     sweep::Experiment& experiment) {
  for (const std::string& each : values.texts("param")) {
    experiment.axes.push_back(sweep::to_axis(sweep::Axis::Kind::parameter, each));
  }
  for (const std::string& each : values.texts("axis")) {
    experiment.axes.push_back(sweep::to_axis(sweep::Axis::Kind::setting, each));
  }
  if (values.has("seeds")) {
    experiment.seeds = sweep::to_seeds("--seeds", values.text("seeds"));
  }
  for (const char* name : {"ticks", "duration"}) {
    if (!values.has(name)) continue;
    experiment.run_arguments.insert(experiment.run_arguments.end(),
                                    {std::string("--") + name, values.text(name)});
  }
  experiment.run_arguments.insert(experiment.run_arguments.end(), for_run.begin(), for_run.end());
}

/// Reads the scene, and takes its seed if there are no others.
void complete(SweepOptions& options) {
  sweep::Definition& definition = options.definition;
  sweep::Experiment& experiment = definition.experiment;
  check(experiment);
  check_run_arguments(experiment.run_arguments);
  auto files = sweep::read_scene(experiment);
  definition.files = std::move(files.hashes);
  options.warnings = std::move(files.warnings);
  if (experiment.seeds.empty()) {
    if (files.seed == 0) {
      throw text::UsageError(
          fmt::format("{} has no random_seed, so that each run would draw its own; "
                      "write seeds, as in --seeds 1..10",
                      experiment.scene));
    }
    experiment.seeds = {files.seed};
    check(experiment);
  }
  const run::Options first = options_of_first_run(experiment, options.settings);
  const bool may_never_end = !first.ticks && first.duration.value_or(files.length) == 0;
  if (may_never_end && !options.settings.timeout) {
    throw text::UsageError(
        fmt::format("{} has no length, so that a run may never end; write "
                    "--duration S or --timeout S",
                    experiment.scene));
  }
}

void read_cluster(const Values& values, SweepOptions& options) {
  check_apart(values, "kubernetes", {"slurm"});
  options.for_slurm = values.has("slurm");
  options.slurm = {values.text("partition"), values.texts("slurm-option")};
  options.kubernetes_file = values.text("kubernetes");
  options.kubernetes = {values.text("image"), values.text("claim"), values.text("mount")};
  const bool for_kubernetes = !options.kubernetes_file.empty();
  if (values.has("chunk")) {
    options.chunk = text::to_integer("--chunk", values.text("chunk"));
    if (*options.chunk == 0) throw text::UsageError("--chunk is 0; write 1 or more runs");
  }
  const auto needs = [&](const char* name, bool has, const char* other) {
    if (!values.has(name) || has) return;
    throw text::UsageError(fmt::format("--{} needs --{}", name, other));
  };
  for (const char* name : {"partition", "slurm-option"}) needs(name, options.for_slurm, "slurm");
  for (const char* name : {"image", "claim", "mount"}) needs(name, for_kubernetes, "kubernetes");
  needs("chunk", options.for_slurm || for_kubernetes, "slurm or --kubernetes");
  if (options.for_slurm && for_kubernetes) {
    throw text::UsageError("--slurm and --kubernetes are two clusters; write one of them");
  }
  for (const char* name : {"image", "claim", "mount"}) {
    if (!for_kubernetes || values.has(name)) continue;
    throw text::UsageError(fmt::format("--kubernetes needs --{} (ziggurat help sweep)", name));
  }
  // A processor for each run, and one run at a time, unless it is said otherwise.
  const bool is_cluster = options.for_slurm || for_kubernetes;
  if (is_cluster && !values.has("jobs")) options.settings.jobs = 1;
}

const std::string& only_word(const Parsed& parsed, const char* missing) {
  if (parsed.positional.empty()) throw text::UsageError(missing);
  if (parsed.positional.size() > 1) {
    throw text::UsageError(
        fmt::format("only one scene, experiment or folder is allowed, which is "
                    "'{}'; remove '{}'",
                    parsed.positional[0], parsed.positional[1]));
  }
  return parsed.positional.front();
}

/// The experiment of a folder.
SweepOptions resumed(const Parsed& parsed, const char* verb) {
  const Values values(parsed.values);
  SweepOptions options;
  read_settings(values, {}, options);
  read_cluster(values, options);
  options.out = only_word(
      parsed, fmt::format("no folder is given; write: ziggurat sweep {} DIR", verb).c_str());
  for (const char* name : {"param", "axis", "seeds", "ticks", "duration", "out"}) {
    if (!values.has(name)) continue;
    throw text::UsageError(
        fmt::format("--{} can't change: {} goes on with the experiment of the folder", name, verb));
  }
  options.definition = sweep::Folder(options.out).definition();
  complete(options);
  return options;
}

}  // namespace

po::options_description sweep_options() {
  po::options_description grid("The runs", help_width);
  grid.add_options()  //
      ("seeds", text_value("LIST"),
       "random seeds: 1..100, or 1,2,7..9; default: the scene's own")  //
      ("param", text_values("NAME=A|B|C"),
       "values of a parameter of the scene; may be repeated")  //
      ("axis", text_values("PATH=A|B|C"),
       "values of the attributes that an XPath from the root element names; may be repeated")  //
      ("ticks", text_value("N"), "length of each run in ticks")                                //
      ("duration", text_value("S"), "length of each run in simulated seconds");
  po::options_description execution("How they are run", help_width);
  execution.add_options()                                                                    //
      ("out", text_value("DIR"), "folder of the results: a new one, or that of this sweep")  //
      ("jobs", text_value("N"), "runs at a time; default: the number of processors")         //
      ("timeout", text_value("S"),
       "end a run that takes more wall time, and count it as failed")                         //
      ("retry-failed", "run again what failed or took too long")                              //
      ("record", text_value("failed|all"), "keep recordings of these runs: runs/N/run.mcap")  //
      ("dry-run", "print the runs as CSV, and start none")                                    //
      ("quiet", "no progress and no summary on stderr");
  po::options_description cluster("On a cluster", help_width);
  cluster.add_options()  //
      ("slurm",
       "submit a job array of Slurm instead of running here; --jobs is for each task, default 1")  //
      ("partition", text_value("NAME"), "of Slurm")  //
      ("slurm-option", text_values("OPTION"),
       "a further option of sbatch, as --slurm-option=--mem=2G; "
       "may be repeated")  //
      ("chunk", text_value("N"),
       "runs of a task, one after the other; default: so many that 100 "
       "tasks are enough")  //
      ("kubernetes", text_value("FILE.yaml"),
       "write the manifest of an indexed Job there instead")  //
      ("image", text_value("NAME"),
       "with --kubernetes: of containers, which have ziggurat in their PATH")  //
      ("claim", text_value("NAME"),
       "with --kubernetes: the PersistentVolumeClaim with scene and results")  //
      ("mount", text_value("PATH"), "with --kubernetes: where it is, here and in the containers");
  po::options_description options("", help_width);
  options.add(grid).add(execution).add(cluster);
  return options;
}

SweepOptions parse_sweep(const Arguments& arguments) {
  const auto [own, for_run] = split(arguments);
  const Parsed parsed = parse(own, sweep_options());
  const Values values(parsed.values);
  const std::string& word =
      only_word(parsed,
                "no scene is given; write: ziggurat sweep SCENE --out DIR, or: ziggurat sweep "
                "EXPERIMENT.toml");
  sweep::ExperimentFile file;
  if (word.ends_with(".toml")) {
    for (const char* name : {"param", "axis", "seeds", "ticks", "duration"}) {
      if (!values.has(name)) continue;
      throw text::UsageError(
          fmt::format("--{} belongs into {}, so that it tells the whole experiment", name, word));
    }
    if (!for_run.empty()) {
      throw text::UsageError(fmt::format("arguments of runs belong into {}, as run = [...]", word));
    }
    file = sweep::read_experiment(word);
  } else {
    file.experiment.scene = fs::absolute(scene_path(word)).lexically_normal().string();
  }
  SweepOptions options;
  options.definition.experiment = std::move(file.experiment);
  read_experiment(values, for_run, options.definition.experiment);
  read_settings(values, file, options);
  read_cluster(values, options);
  if (options.out.empty() && !options.dry_run) {
    throw text::UsageError("no folder for the results is given; write --out DIR");
  }
  complete(options);
  return options;
}

SweepOptions parse_resume(const Arguments& arguments) {
  return resumed(parse(arguments, sweep_options()), "resume");
}

TaskOptions parse_task(const Arguments& arguments) {
  po::options_description known = sweep_options();
  known.add_options()("task", po::value<std::string>());
  const Parsed parsed = parse(arguments, known);
  const Values values(parsed.values);
  TaskOptions options{resumed(parsed, "task"), {}};
  if (values.has("task")) {
    options.task = text::to_integer("--task", values.text("task"));
  }
  return options;
}

}  // namespace ziggurat::cli
