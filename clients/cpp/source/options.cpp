#include <cstdlib>
#include <stdexcept>

#include "ziggurat/session.h"

namespace ziggurat {

Options Options::from_environment() {
  const char* endpoint = std::getenv("ZIGGURAT_ENDPOINT");
  Options options;
  options.endpoint = endpoint == nullptr || *endpoint == '\0' ? find_server() : endpoint;
  if (const char* controller = std::getenv("ZIGGURAT_CONTROLLER")) options.controller = controller;
  if (const char* key = std::getenv("ZIGGURAT_SERVER_KEY")) options.server_key = key;
  if (const char* secret = std::getenv("ZIGGURAT_CURVE_SECRET")) options.curve_secret = secret;
  return options;
}

}  // namespace ziggurat
