#include <cstdlib>
#include <stdexcept>

#include "ziggurat/session.h"

namespace ziggurat {

Options Options::from_environment() {
  const char* endpoint = std::getenv("ZIGGURAT_ENDPOINT");
  if (endpoint == nullptr || *endpoint == '\0') {
    throw std::invalid_argument(
        "ZIGGURAT_ENDPOINT is not set; set it to the server's endpoint, for example "
        "tcp://127.0.0.1:7400");
  }
  Options options;
  options.endpoint = endpoint;
  if (const char* controller = std::getenv("ZIGGURAT_CONTROLLER")) options.controller = controller;
  if (const char* key = std::getenv("ZIGGURAT_SERVER_KEY")) options.server_key = key;
  if (const char* secret = std::getenv("ZIGGURAT_CURVE_SECRET")) options.curve_secret = secret;
  return options;
}

}  // namespace ziggurat
