// SPDX-License-Identifier: MIT
#pragma once
// Readings of robots and the commands that answered them: `--readings`.

#include <string>
#include <vector>

#include "outputs/output_file.h"
#include "world/commands.h"
#include "world/layout.h"
#include "world/metric.h"
#include "world/state.h"

namespace ziggurat::outputs {

/// One line per tick and robot that is there, in scene order: ziggurat.v1.Reading as protobuf JSON
/// with the field names of recording.proto, devices sorted by id. A director that set metrics at
/// the tick has a line, too, with its id as `robot` and nothing else.
class Readings {
 public:
  /// Keeps a reference to `layout`. @throws WriteError
  Readings(std::string path, const world::Layout& layout);

  /// Writes true state, readings, and the commands that answered them, of one tick.
  /// @throws WriteError
  /// @param metrics  that were set then
  void write(const world::State& state, const world::Observations& observations,
             const world::Commands& commands, const std::vector<world::Metric>& metrics = {});
  void flush() { file_.flush(); }  ///< @throws WriteError
  void close() { file_.close(); }

 private:
  const world::Layout& layout_;
  OutputFile file_;
};

}  // namespace ziggurat::outputs
