#pragma once
// Metrics of commands and leaves -> plain data.

#include <optional>
#include <vector>

#include "wire/messages.h"
#include "wire/roster.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {

/// Checks the metrics of a session.
std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics,
                           const Roster& roster);

/// The same for their names and values only.
std::optional<Fault> check_names_and_values(
    const google::protobuf::RepeatedPtrField<v1::Metric>& metrics);

/// Appends checked metrics. Those of robots that were taken over are skipped.
void append(const google::protobuf::RepeatedPtrField<v1::Metric>& metrics, const Roster& roster,
            std::vector<Metric>& to);

}  // namespace ziggurat::wire
