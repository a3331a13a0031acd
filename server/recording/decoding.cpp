// SPDX-License-Identifier: MIT
#include "recording/decoding.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>

#include <memory>

#include "ziggurat/v1/extent.h"

namespace ziggurat::recording {
namespace {

constexpr std::size_t kept_memory = std::size_t{1} << 20;  // of the message before [bytes]
constexpr std::size_t mebibyte = std::size_t{1} << 20;

/// An array that is empty again keeps its memory: those of several messages would add up.
void forget(google::protobuf::Message& message) {
  if (message.SpaceUsedLong() <= kept_memory) return;
  const std::unique_ptr<google::protobuf::Message> empty(message.New());
  message.GetReflection()->Swap(&message, empty.get());
}

}  // namespace

Bound bound_of(const google::protobuf::Descriptor& type) {
  const std::string& name = type.full_name();
  if (name == "ziggurat.v1.World" || name == "foxglove.SceneUpdate") return bound_of_worlds;
  if (name == "ziggurat.v1.Inputs" || name == "ziggurat.v1.ExactState") return bound_of_inputs;
  return bound_of_others;
}

std::optional<std::string> decode(std::string_view bytes, google::protobuf::Message& to) {
  const auto& type = *to.GetDescriptor();
  const Bound most = bound_of(type);
  if (bytes.size() > most.bytes) {
    return fmt::format("has {} bytes; at most {} are read, and no run writes as many", bytes.size(),
                       most.bytes);
  }
  if (v1::decoded_size(bytes, type, most.memory) > most.memory) {
    return fmt::format("has parts that take more than {} MiB of memory, which none of a run does",
                       most.memory / mebibyte);
  }
  forget(to);
  // protobuf would print a line for text that is no UTF-8; once, because threads decode side by
  // side.
  [[maybe_unused]] static const auto printing = google::protobuf::SetLogHandler(nullptr);
  if (to.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
  return "is damaged";
}

}  // namespace ziggurat::recording
