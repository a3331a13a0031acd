// SPDX-License-Identifier: MIT
#pragma once
// Common parts of ctl and top: the connection, and the printed status.

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <memory>
#include <string>
#include <vector>

#include "reports/console.h"
#include "ziggurat/supervisor.h"

namespace ziggurat::cli {

/// The options with keys, for protected servers.
void add_key_options(boost::program_options::options_description& options);

/// Takes the endpoint from the front of the words if it is one; otherwise ZIGGURAT_ENDPOINT, or the
/// only server that runs here. @throws std::invalid_argument if there is none
std::string take_endpoint(std::vector<std::string>& words);

SupervisorOptions supervisor_options(const std::string& endpoint,
                                     const boost::program_options::variables_map& values,
                                     std::string name);

/// Connects; if nothing answers for a moment, a notice says so while it goes on trying.
std::unique_ptr<Supervisor> connect(SupervisorOptions options, reports::Console& console);

/// Several lines without line feed at the end: the world, one row per session, where the wall time
/// goes.
std::string to_text(const ServerStatus& status);

}  // namespace ziggurat::cli
