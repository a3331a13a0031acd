// SPDX-License-Identifier: MIT
#include "view/messages.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace ziggurat::view {
namespace {

using Json = nlohmann::json;
using Kind = wire::Request::Kind;

struct Service {
  const char* name;
  Kind kind;  ///< none: /speed
  const char* request;
};

constexpr const char* no_fields = R"({"type":"object","properties":{}})";
constexpr std::size_t most_values = 100'000;  // of a message in JSON: each takes some 100 bytes
/// By id minus 1.
constexpr std::array services{
    Service{"/pause", Kind::pause, no_fields},
    Service{"/resume", Kind::resume, no_fields},
    Service{"/step", Kind::step,
            R"({"type":"object","properties":{"ticks":{"type":"integer","minimum":1}}})"},
    Service{"/reset", Kind::reset,
            R"({"type":"object","properties":{"seed":{"type":"integer","minimum":1}}})"},
    Service{"/speed", Kind::none,
            R"({"type":"object","properties":{"factor":{"type":"number"}},"required":["factor"]})"},
    Service{
        "/move", Kind::move,
        R"({"type":"object","properties":{"entity":{"type":"string"},"position":{"type":"array",)"
        R"("items":{"type":"number"}},"orientation":{"type":"array","items":{"type":"number"}},)"
        R"("may_overlap":{"type":"boolean"}},)"
        R"("required":["entity","position"]})"},
    Service{"/spawn", Kind::spawn,
            R"({"type":"object","properties":{"xml":{"type":"string"}},"required":["xml"]})"},
    Service{"/remove", Kind::remove,
            R"({"type":"object","properties":{"entity":{"type":"string"}},"required":["entity"]})"},
    Service{"/shutdown", Kind::shutdown, no_fields},
};
constexpr const char* response_schema =
    R"({"type":"object","properties":{"tick":{"type":"integer"}}})";

template <class Integer>
void put(Integer number, std::string& to) {  // little-endian
  for (std::size_t i = 0; i < sizeof number; ++i) {
    to += static_cast<char>(number >> (8 * i) & 0xff);
  }
}

std::uint32_t get(std::string_view bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 4; i-- > 0;) {
    number = number << 8 | static_cast<std::uint8_t>(bytes[i]);
  }
  return number;
}

Item text_item(const Json& json) {
  return {.is_text = true,
          .head = json.dump(-1, ' ', false, Json::error_handler_t::replace),
          .content = nullptr};
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_padding = i + k > bytes.size();
      text += is_padding ? '=' : letters[three >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

/// None if it is no JSON, or has so many values that they would take much memory.
std::optional<Json> parse(std::string_view text) {
  if (text.find('\0') != text.npos)
    return std::nullopt;  // for nlohmann's parser the end of the text
  std::size_t values = 0;
  bool is_in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_in_text && text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      is_in_text = !is_in_text;
    } else if (!is_in_text && std::string_view("[{,").find(text[i]) != std::string_view::npos) {
      if (++values > most_values) return std::nullopt;
    }
  }
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

// --- reading; each of these throws Wrong
// ----------------------------------------------------------

const Json& field(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) throw Wrong{fmt::format("\"{}\" is missing", name)};
  return *found;
}

const Json& list(const Json& object, const char* name) {
  const Json& value = field(object, name);
  if (!value.is_array()) throw Wrong{fmt::format("\"{}\" is no list", name)};
  return value;
}

std::uint32_t id_of(const Json& value, const char* name) {
  if (!value.is_number_unsigned() ||
      value.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    throw Wrong{fmt::format("\"{}\" is no integer from 0 to 4294967295", name)};
  }
  return value.get<std::uint32_t>();
}

std::string text_of(const Json& value, const char* name) {
  if (!value.is_string()) throw Wrong{fmt::format("\"{}\" is no text", name)};
  return value.get<std::string>();
}

std::optional<std::string> optional_id(const Json& object) {
  const auto found = object.find("id");
  if (found == object.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

std::vector<std::string> texts(const Json& object, const char* name) {
  std::vector<std::string> texts;
  for (const Json& value : list(object, name)) texts.push_back(text_of(value, name));
  return texts;
}

Incoming read_subscribe(const Json& json) {
  Subscribe message;
  for (const Json& entry : list(json, "subscriptions")) {
    if (!entry.is_object()) throw Wrong{"a subscription is no object"};
    message.entries.push_back(
        {id_of(field(entry, "id"), "id"), id_of(field(entry, "channelId"), "channelId")});
  }
  return message;
}

Incoming read_set_parameters(const Json& json) {
  SetParameters message{{}, optional_id(json)};
  for (const Json& entry : list(json, "parameters")) {
    if (!entry.is_object()) throw Wrong{"a parameter is no object"};
    Parameter parameter{text_of(field(entry, "name"), "name"), {}};
    const auto value = entry.find("value");
    if (value == entry.end()) {
    } else if (value->is_boolean()) {
      parameter.value = value->get<bool>();
    } else if (value->is_number()) {
      parameter.value = value->get<double>();
    } else if (value->is_string()) {
      parameter.value = value->get<std::string>();
    }
    message.parameters.push_back(std::move(parameter));
  }
  return message;
}

Incoming read_object(const Json& json) {
  const std::string op = text_of(field(json, "op"), "op");
  if (op == "subscribe") return read_subscribe(json);
  if (op == "unsubscribe") {
    Unsubscribe message;
    for (const Json& id : list(json, "subscriptionIds")) {
      message.ids.push_back(id_of(id, "subscriptionIds"));
    }
    return message;
  }
  if (op == "getParameters") {
    return GetParameters{texts(json, "parameterNames"), optional_id(json)};
  }
  if (op == "setParameters") return read_set_parameters(json);
  if (op == "subscribeParameterUpdates") return SubscribeParameters{true};
  if (op == "unsubscribeParameterUpdates") return SubscribeParameters{false};
  if (op == "subscribeConnectionGraph") return SubscribeGraph{true};
  if (op == "unsubscribeConnectionGraph") return SubscribeGraph{false};
  if (op == "ready") return Ready{};
  throw Wrong{fmt::format("\"{}\" is not served", op.substr(0, 64))};
}

std::uint64_t integer(const Json& json, const char* name) {
  const Json& value = field(json, name);
  if (!value.is_number_unsigned()) throw Wrong{fmt::format("\"{}\" is no integer >= 0", name)};
  return value.get<std::uint64_t>();
}

std::vector<double> numbers(const Json& json, const char* name) {
  std::vector<double> numbers;
  for (const Json& value : list(json, name)) {
    if (!value.is_number()) throw Wrong{fmt::format("\"{}\" has a value that is no number", name)};
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

/// Fields of the request that are there.
void read_fields(const Json& json, ViewerCall& call) {
  wire::Request& request = call.request;
  switch (request.kind) {
    case Kind::none: {
      const Json& factor = field(json, "factor");
      constexpr double least = 1e-6, most = 1e6;
      const double value = factor.is_number() ? factor.get<double>() : -1;
      if (value != 0 && !(value >= least && value <= most)) {
        throw Wrong{"\"factor\" must be 1e-6 to 1e6, or 0 for as fast as it goes"};
      }
      call.speed = value;
      return;
    }
    case Kind::step:
      request.ticks = json.contains("ticks") ? integer(json, "ticks") : 1;
      return;
    case Kind::reset:
      if (json.contains("seed")) request.seed = integer(json, "seed");
      return;
    case Kind::move:
      request.text = text_of(field(json, "entity"), "entity");
      request.position = numbers(json, "position");
      if (json.contains("orientation")) request.orientation = numbers(json, "orientation");
      if (json.contains("may_overlap")) {
        const Json& may = field(json, "may_overlap");
        if (!may.is_boolean()) throw Wrong{"\"may_overlap\" must be true or false"};
        request.may_overlap = may.get<bool>();
      }
      return;
    case Kind::spawn:
      request.text = text_of(field(json, "xml"), "xml");
      return;
    case Kind::remove:
      request.text = text_of(field(json, "entity"), "entity");
      return;
    default:
      return;
  }
}

}  // namespace

Incoming read_text(std::string_view text) {
  const auto json = parse(text);
  if (!json || !json->is_object()) {
    return Wrong{fmt::format("the message is no JSON object of at most {} values", most_values)};
  }
  try {
    return read_object(*json);
  } catch (const Wrong& wrong) {
    return wrong;
  }
}

Incoming read_binary(std::string_view bytes) {
  constexpr std::size_t head = 13;
  if (bytes.empty() || bytes[0] != 2) return Wrong{"binary messages are calls of services only"};
  if (bytes.size() < head) return Wrong{"the call of a service is too short"};
  const std::uint32_t length = get(bytes.substr(9, 4));
  if (length > bytes.size() - head) return Wrong{"the call's encoding is longer than the call"};
  return CallService{get(bytes.substr(1, 4)), get(bytes.substr(5, 4)),
                     std::string(bytes.substr(head, length)),
                     std::string(bytes.substr(head + length))};
}

std::variant<ViewerCall, std::string> read_call(const CallService& from) {
  if (from.service == 0 || from.service > services.size()) return "There is no such service.";
  const Service& service = services[from.service - 1];
  if (from.encoding != "json") {
    return fmt::format("The encoding of {} must be json.", service.name);
  }
  ViewerCall call{.service = from.service, .number = from.call, .request = {}, .speed = {}};
  call.request.kind = service.kind;
  call.request.id = from.call;
  const auto json = from.payload.empty() ? Json::object() : parse(from.payload);
  if (!json || !json->is_object()) {
    return fmt::format("The request of {} must be a JSON object of at most {} values.",
                       service.name, most_values);
  }
  try {
    read_fields(*json, call);
  } catch (const Wrong& wrong) {
    return fmt::format("{}: {}.", service.name, wrong.why);
  }
  return call;
}

// --- writing
// --------------------------------------------------------------------------------------

Item server_info(const Introduction& from) {
  return text_item({{"op", "serverInfo"},
                    {"name", "ziggurat"},
                    {"capabilities", Json::array({"time", "services", "parameters",
                                                  "parametersSubscribe", "connectionGraph"})},
                    {"supportedEncodings", Json::array({"json"})},
                    {"metadata",
                     {{"version", from.version},
                      {"scene", from.scene},
                      {"may_steer", from.may_steer ? "true" : "false"},
                      {"takes_ready", "true"}}},
                    {"sessionId", from.session}});
}

Item advertise(std::span<const channels::Channel* const> channels) {
  Json list = Json::array();
  for (const channels::Channel* channel : channels) {
    list.push_back({{"id", channel->id},
                    {"topic", channel->topic},
                    {"encoding", "protobuf"},
                    {"schemaName", channel->schema->name},
                    {"schema", base64(channel->schema->descriptors)},
                    {"schemaEncoding", "protobuf"}});
  }
  return text_item({{"op", "advertise"}, {"channels", std::move(list)}});
}

Item unadvertise(std::span<const std::uint32_t> ids) {
  return text_item(
      {{"op", "unadvertise"}, {"channelIds", std::vector<std::uint32_t>(ids.begin(), ids.end())}});
}

Item advertise_services() {
  Json list = Json::array();
  for (std::size_t i = 0; i < services.size(); ++i) {
    const auto part = [&](const char* what, const char* schema) {
      return Json{{"encoding", "json"},
                  {"schemaName", std::string(services[i].name).substr(1) + what},
                  {"schemaEncoding", "jsonschema"},
                  {"schema", schema}};
    };
    list.push_back({{"id", i + 1},
                    {"name", services[i].name},
                    {"type", std::string(services[i].name).substr(1)},
                    {"request", part("_request", services[i].request)},
                    {"response", part("_response", response_schema)},
                    {"requestSchema", services[i].request},  // for viewers of before 2023
                    {"responseSchema", response_schema}});
  }
  return text_item({{"op", "advertiseServices"}, {"services", std::move(list)}});
}

Item parameter_values(std::span<const Parameter> parameters, const std::optional<std::string>& id) {
  Json list = Json::array();
  for (const Parameter& parameter : parameters) {
    Json entry{{"name", parameter.name}};
    std::visit(
        [&](const auto& value) {
          using Value = std::decay_t<decltype(value)>;
          if constexpr (!std::is_same_v<Value, std::monostate>) entry["value"] = value;
          if constexpr (std::is_same_v<Value, double>) entry["type"] = "float64";
        },
        parameter.value);
    list.push_back(std::move(entry));
  }
  Json json{{"op", "parameterValues"}, {"parameters", std::move(list)}};
  if (id) json["id"] = *id;
  return text_item(json);
}

Item connection_graph(std::span<const channels::Channel> channels,
                      std::span<const std::string> subscribed) {
  Json published = Json::array(), wanted = Json::array(), offered = Json::array();
  for (const channels::Channel& channel : channels) {
    published.push_back({{"name", channel.topic}, {"publisherIds", Json::array({"ziggurat"})}});
  }
  for (const std::string& topic : subscribed) {
    wanted.push_back({{"name", topic}, {"subscriberIds", Json::array({"viewers"})}});
  }
  for (const Service& service : services) {
    offered.push_back({{"name", service.name}, {"providerIds", Json::array({"ziggurat"})}});
  }
  return text_item({{"op", "connectionGraphUpdate"},
                    {"publishedTopics", std::move(published)},
                    {"subscribedTopics", std::move(wanted)},
                    {"advertisedServices", std::move(offered)},
                    {"removedTopics", Json::array()},
                    {"removedServices", Json::array()}});
}

Item warning(const std::string& text) {
  return text_item({{"op", "status"}, {"level", 1}, {"message", text}});
}

Item time(std::int64_t time_ns) {
  Item item;
  item.keep = Keep::newest;
  item.head = '\x02';
  put(static_cast<std::uint64_t>(time_ns), item.head);
  return item;
}

Item message(std::uint32_t subscription, const channels::Message& message, Keep keep) {
  Item item;
  item.keep = keep;
  item.channel = message.channel;
  item.head = '\x01';
  put(subscription, item.head);
  put(static_cast<std::uint64_t>(message.time_ns), item.head);
  item.content = message.content;
  return item;
}

Item service_answer(std::uint32_t service, std::uint32_t call, const std::string& json) {
  Item item;
  item.head = '\x03';
  put(service, item.head);
  put(call, item.head);
  put(std::uint32_t{4}, item.head);
  item.head += "json" + json;
  return item;
}

Item service_failure(std::uint32_t service, std::uint32_t call, const std::string& text) {
  return text_item(
      {{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", text}});
}

}  // namespace ziggurat::view
