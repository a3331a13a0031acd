// SPDX-License-Identifier: MIT
#pragma once
// The files of the page, over HTTP.

#include <string>
#include <string_view>

#include "http/answer.h"

namespace ziggurat::view {

class Page {
 public:
  /// @param folder  where the files are, some with the same in gzip as `FILE.gz` beside them; if it
  /// has no index.html, a text says so
  explicit Page(std::string folder) : folder_(std::move(folder)) {}

  /// @param target  path and query
  /// @param known_etag  of `If-None-Match`; empty: none
  http::Answer get(std::string_view target, std::string_view known_etag) const;

 private:
  std::string folder_;
};

/// Content security policy of this server's pages: they load only its files and its WebSocket.
/// @param host  of the request
std::string content_security_policy(std::string_view host);

}  // namespace ziggurat::view
