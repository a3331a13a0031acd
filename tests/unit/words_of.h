// SPDX-License-Identifier: MIT
#pragma once
// Errors by their words.

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace ziggurat {

/// Words of the Error that an action throws; empty if it throws none.
template <class Error>
std::string words_of(auto action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Tells whether an action throws an Error whose words have this part.
template <class Error>
::testing::AssertionResult fails_with(std::string_view part, auto action) {
  const std::string words = words_of<Error>(action);
  if (words.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << words << "' does not have '" << part << "'";
}

}  // namespace ziggurat
