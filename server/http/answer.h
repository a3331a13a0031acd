#pragma once
// Answer to a request.

#include <string>

namespace ziggurat::http {

struct Answer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string etag;  ///< empty: the answer is not to be kept
  std::string body;
};

}  // namespace ziggurat::http
