#include "cli/options.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

auto text(const char* name) { return po::value<std::string>()->value_name(name); }
auto texts(const char* name) {
  return po::value<std::vector<std::string>>()->composing()->value_name(name);
}

constexpr unsigned width = 96;  // of the help [characters]

void add_variation(po::options_description& options) {
  options.add_options()  //
      ("set", texts("PATH=VALUE"),
       "set the attributes that an XPath from the root element names, as in --set "
       "'physics_engines/dynamics3d/@iterations=7'; may be repeated")  //
      ("param", texts("NAME=VALUE"),
       "the value of a parameter of the scene's <parameters>, instead of its own; may be repeated");
}

void add_lua_limits(po::options_description& options) {
  options.add_options()                                                                   //
      ("lua-memory", text("MIB"), "largest memory of a robot's Lua script; default 256")  //
      ("lua-instructions", text("MILLIONS"),
       "most Lua instructions of a robot at one tick, in millions; default 1000")  //
      ("lua-time", text("SECONDS"),
       "most processor time of a robot's Lua script at one tick; default 20");
}

po::options_description scene_options() {
  po::options_description options("Reading the scene", width);
  add_variation(options);
  options.add_options()  //
      ("lenient",
       "unknown attributes, libraries of <loop_functions> and floors that they draw are notices, "
       "not faults")  //
      ("max-scene-size", text("SIZE"), "largest scene file, as 64M (the default)");
  return options;
}

constexpr const char* seed_help = "random seed; 0 draws one from the system and prints it";
constexpr const char* clock_help =
    "physical time per tick: 1/ticks_per_second, or the slow clock of ARGoS 3.0.0-beta50";

po::options_description world_options() {
  po::options_description options("The run", width);
  options.add_options()                                              //
      ("ticks", text("N"), "N ticks instead of the scene's length")  //
      ("duration", text("S"),
       "S simulated seconds instead of the scene's length; "
       "0 is until Ctrl-C")                          //
      ("seed", text("N"), seed_help)                 //
      ("clock", text("nominal|beta50"), clock_help)  //
      ("real-time", po::value<std::string>()->implicit_value("1")->value_name("FACTOR"),
       "pace to the wall clock, FACTOR times as fast (default 1)")  //
      ("threads", text("N"),
       "N threads share the physics, with the same results for any number; default 1")  //
      ("endpoint", texts("URL"),
       "listen here too: tcp://127.0.0.1:5770, tcp://127.0.0.1:* or "
       "ipc:///short/path; may be repeated")  //
      ("deadline", texts("[CONTROLLER=]ACTION[:MS[:BUDGET]]"),
       "when a controller (all, if none is named) has not answered after MS milliseconds: wait, "
       "hold, zero, drop or stop; drop and stop hold the last command for BUDGET misses in a row "
       "first; hold and zero drop the robots after BUDGET misses; may be repeated")  //
      ("lease", text("S"),
       "when a controller disconnects, keep its robots for it for S seconds")                //
      ("curve-secret", text("FILE"), "protect endpoints with this key ('ziggurat keygen')")  //
      ("curve-clients", text("FILE"),
       "the allowed clients: lines KEY ROLE[,ROLE] [robots=GLOB,..] [controllers=GLOB,..] "
       "[takeover=yes|no] [NAME]; a ROLE is controller, director, supervisor or observer")  //
      ("paused", "stand at tick 0 until a supervisor resumes ('ziggurat ctl URL resume')")  //
      ("end-with-input",
       "end, as with Ctrl-C, when standard input ends: a program that starts this one with a pipe "
       "does not leave it "
       "behind, however it ends itself")                                                  //
      ("fail-fast", "end when the first controller fails or the first robot is dropped")  //
      ("allow-drops", "robots that a deadline dropped do not make the exit code 3")       //
      ("allow-director",
       "clients may direct the world although the scene has no <director> for them")  //
      ("insecure", "allow endpoints that other machines can reach")                   //
      ("allow-spawned-scripts", texts("DIR"),
       "robots that a supervisor spawns may use the scripts and files below DIR, too; otherwise "
       "only "
       "scripts that the scene names; may be repeated")  //
      ("snapshot-folder", text("DIR"),
       "write the snapshots that supervisors take below DIR, and read them from there")  //
      ("metrics", text("HOST:PORT"),
       "serve the run's status over HTTP there: /metrics for Prometheus, /status as JSON")  //
      ("view", po::value<std::string>()->implicit_value("")->value_name("HOST:PORT"),
       "show the run in a browser, Foxglove or Lichtblick: prints the address (default "
       "127.0.0.1:8765, or a free port)")  //
      ("view-token", text("TOKEN"),
       "the token of that address instead of a random one: 16 characters or more");
  return options;
}

po::options_description hil_options() {
  po::options_description options("Hardware in the loop", width);
  options.add_options()  //
      ("hil",
       "pace to the wall clock and never wait: a controller that has not answered after nine "
       "tenths of a tick holds its last command, unless --deadline sets another policy")  //
      ("inject", texts("[CONTROLLER=][DIRECTION:]WHAT"),
       "delay or lose messages, as a network does: latency=5ms,jitter=2ms,loss=1% to a controller "
       "(all, if none is named) and from it, or only in the DIRECTION observations or commands; "
       "may be repeated")  //
      ("gate", text("CONDITIONS"),
       "exit with 4 unless every controller meets them: p99<2ms,misses<0.1% (p50, p90, "
       "p99, p99.9, max, jitter, misses, run: of misses in a row, late)")  //
      ("report-card", text("FILE"),
       "how controllers kept up, as JSON, as a picture if FILE ends with .svg, or tick by tick if "
       "it "
       "ends with .csv")  //
      ("warm-up", text("N"), "the first N ticks do not count for the gate and the report card");
  return options;
}

po::options_description output_options() {
  po::options_description options("Outputs", width);
  options.add_options()                                                                      //
      ("quiet", "no progress, notices and summary on stderr")                                //
      ("json", "messages as JSON for programs: one object per line")                         //
      ("hash", "last line of stdout: hash TICK DIGITS of the final state")                   //
      ("hash-file", text("FILE"), "the same line for every tick")                            //
      ("trace", text("FILE.csv"), "world poses of everything at every tick")                 //
      ("readings", text("FILE.jsonl"), "readings and commands of all robots at every tick")  //
      ("rays", text("FILE.jsonl"), "tested rays and radio links of devices with show_rays")  //
      ("images", text("DIR"), "PNG per tick and camera with image: ROBOT.CAMERA.TICK.png")   //
      ("summary", text("FILE.json"), "the summary as JSON");
  return options;
}

po::options_description record_options() {
  po::options_description options("Recording", width);
  options.add_options()  //
      ("record", text("FILE.mcap"),
       "everything: to replay the run to the bit, to look at it again (MCAP, as Foxglove reads "
       "it)")  //
      ("record-topics", texts("PATTERN"),
       "only topics that match, as '/poses' or '/robots/r1*/*'; may be repeated; what a replay "
       "needs "
       "is always there")                                                                      //
      ("record-every", text("N"), "pictures of every Nth tick only")                           //
      ("record-compression", text("zstd|lz4|none"), "default zstd; lz4 is faster and larger")  //
      ("record-paths",
       "record paths and the command line as they were written, not below the scene's folder")  //
      ("record-strict", "end the run if the recording can't be written, as when the disk is full");
  return options;
}

po::options_description controller_options() {
  po::options_description options("Controllers", width);
  options.add_options()  //
      ("lua-processes", text("N"),
       "share the Lua robots among N processes; default 1, 0 is one for each robot; spawned Lua "
       "robots share as many others, at most 16")  //
      ("trust-scripts",
       "Lua scripts may start programs and use all of Lua and all files; otherwise they use only "
       "files below the folders of the scene, its includes and its scripts");
  add_lua_limits(options);
  options.add_options()                                                           //
      ("controller", texts("ID=CMD"), "start CMD for the scene's controller ID")  //
      ("restart", texts("[ID=]N"),
       "a process of the scene's controller ID (of any, without ID) that dies is started again, up "
       "to N "
       "times: it resumes its session at the present tick; may be repeated");
  return options;
}

}  // namespace

po::options_description picture_options() {
  po::options_description options("The picture", width);
  options.add_options()                                                                         //
      ("out", text("FILE.png"), "output file; for several pictures, %03d in it is the number")  //
      ("at", text("S,S,..."), "simulated seconds, one picture each (default 0)")                //
      ("eye", text("X,Y,Z"), "viewpoint [m] (default: the whole arena is in view)")             //
      ("look-at", text("X,Y,Z"), "point in the centre [m] (default: the middle of the arena)")  //
      ("size", text("WxH"), "pixels (default 1280x720)")                                        //
      ("fov", text("DEGREES"), "angle from the left edge to the right edge (default 46)")       //
      ("follow", text("ENTITY"), "the view moves with this entity")                             //
      ("layers", text("NAME,..."), "draw rays, frusta, labels, too")                            //
      ("video", text("FILE"), "a film: .mp4, .webm, .webp or .gif; needs ffmpeg")               //
      ("fps", text("N"), "frames of the film per second (default 30)")                          //
      ("speed", text("FACTOR"), "simulated seconds per second of the film (default 1)")         //
      ("from", text("S"), "its beginning in simulated seconds (default 0)")                     //
      ("to", text("S"), "its end (default: the end of the scene)");
  return options;
}

po::options_description run_options() {
  const po::options_description processes = controller_options();
  po::options_description options("", width);
  options.add(world_options())
      .add(hil_options())
      .add(processes)
      .add(output_options())
      .add(record_options())
      .add(scene_options());
  return options;
}

po::options_description serve_options() {
  po::options_description directors("Directors", width);
  directors.add_options()(
      "start-directors",
      "start the scene's directors, as 'ziggurat run' does; controllers connect from outside");
  po::options_description options("", width);
  options.add(world_options())
      .add(hil_options())
      .add(directors)
      .add(output_options())
      .add(record_options())
      .add(scene_options());
  return options;
}

po::options_description check_options() {
  po::options_description options("", width);
  options.add(scene_options())
      .add_options()("clock", text("nominal|beta50"), clock_help)(
          "json", "the report as JSON on stdout")("quiet", "faults only")(
          "strict", "exit code 1 also for warnings");
  return options;
}

po::options_description render_options() {
  po::options_description run("The run", width);
  run.add_options()                                  //
      ("seed", text("N"), seed_help)                 //
      ("clock", text("nominal|beta50"), clock_help)  //
      ("without-controllers", "start no controllers; the robots do nothing")(
          "quiet", "no notices and no summary")(
          "json", "messages as JSON for programs: one object per line");
  po::options_description options("", width);
  options.add(picture_options()).add(run).add(controller_options()).add(scene_options());
  return options;
}

po::options_description replay_options() {
  po::options_description replay("The replay", width);
  replay.add_options()                                                  //
      ("until", text("TICK"), "end at the first state with this tick")  //
      ("from-poses",
       "show the recorded poses and simulate nothing: with --view and --trace; what robots sense "
       "is "
       "not shown, and nothing is compared")  //
      ("real-time", po::value<std::string>()->implicit_value("1")->value_name("FACTOR"),
       "pace to the wall clock, FACTOR times as fast (default 1)")  //
      ("view", po::value<std::string>()->implicit_value("")->value_name("HOST:PORT"),
       "show it in a browser, Foxglove or Lichtblick, paced as with --real-time: prints the "
       "address (default 127.0.0.1:8765, or a free port)")  //
      ("view-token", text("TOKEN"),
       "the token of that address instead of a random one: 16 characters or more")  //
      ("insecure", "allow an address that other machines can reach");
  po::options_description options("", width);
  options.add(replay).add(output_options()).add(picture_options());
  return options;
}

po::options_description fork_options() {
  po::options_description fork("The fork", width);
  add_variation(fork);
  fork.add_options()  //
      ("at", text("TICK"),
       "the recorded state from which it goes on: the first with this tick; required")  //
      ("fresh",
       "controllers begin at that tick; otherwise they are first given what robots sensed before, "
       "tick by tick")                                                                     //
      ("controller", texts("ID=CMD"), "start CMD for the controller ID; may be repeated")  //
      ("script", texts("NAME=FILE.lua"),
       "FILE instead of the embedded script NAME ('ziggurat info' lists them); may be repeated")  //
      ("trust-recorded-commands",
       "start the commands that the recording names; they can do anything that you can do")  //
      ("without-controllers", "start no controllers; the robots do nothing")                 //
      ("lua-processes", text("N"),
       "share the Lua robots among N processes; default 1, 0 is one for each robot");
  add_lua_limits(fork);
  po::options_description options("", width);
  options.add(fork).add(world_options()).add(output_options()).add(record_options());
  return options;
}

}  // namespace ziggurat::cli
