// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <sstream>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "network/keys.h"
#include "reports/console.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description keygen_options() {
  po::options_description options("", 96);
  options.add_options()("out", po::value<std::string>()->value_name("PREFIX"),
                        "files to write: PREFIX.secret and PREFIX.public (default: ziggurat)");
  return options;
}

}  // namespace

std::string help_keygen() {
  std::ostringstream text;
  text << R"text(usage: ziggurat keygen [--out PREFIX]

Makes a pair of keys for protected connections (CURVE), and prints the public key. Only its owner can
read PREFIX.secret; keep it on its machine. PREFIX.public is no secret. Existing files are not
replaced.

  ziggurat keygen --out server
  ziggurat keygen --out alice
  echo "$(cat alice.public) controller Alice's robots" > clients.txt
      keys of the server and of a client, and the list of allowed clients
  echo "$(cat bob.public) controller robots=scout*,r7 takeover=no Bob" >> clients.txt
      Bob drives only these robots, and takes none from others
  ziggurat serve vehicle.argos --endpoint tcp://0.0.0.0:5770 \
                --curve-secret server.secret --curve-clients clients.txt
  ziggurat-lua --connect tcp://192.0.2.1:5770 --server-key "$(cat server.public)" \
               --curve-secret alice.secret

Exit codes: 0 finished; 1 fault of arguments or environment.

)text" << keygen_options();
  return text.str();
}

int execute_keygen(const Arguments& arguments) {
  const auto parsed = parse(arguments, keygen_options());
  if (!parsed.positional.empty()) {
    throw text::UsageError(fmt::format("unexpected '{}'; write: ziggurat keygen [--out PREFIX]",
                                       parsed.positional[0]));
  }
  const std::string prefix =
      parsed.values.count("out") > 0 ? parsed.values["out"].as<std::string>() : "ziggurat";
  const std::string name = prefix.substr(prefix.rfind('/') + 1);
  if (name.empty() || name == "." || name == "..") {
    throw text::UsageError(fmt::format(
        "--out is '{0}', a folder; write the beginning of two names in it, as {0}{1}server", prefix,
        name.empty() ? "" : "/"));
  }
  reports::Console console;
  console.result(network::write_key_pair(prefix));
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
