#include "http/port.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace ziggurat::http {
namespace {

Answer read(std::string_view path) {
  return {path == "/" ? 200u : 404u, "text/plain", {}, "0123456789"};
}

std::string answer(const std::string& request) {
  return answer_at_port(request, "127.0.0.1", false, read);
}

TEST(Port, AnswersHeadWithoutTheText) {
  const std::string whole = answer("GET / HTTP/1.1\r\n\r\n"), head = answer("HEAD / HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(whole.ends_with("\r\n\r\n0123456789")) << whole;
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
  EXPECT_NE(head.find("Content-Length: 10\r\n"), std::string::npos) << head;
}

TEST(Port, EndsTheConnectionAfterAnAnswer) {
  EXPECT_NE(answer("GET / HTTP/1.1\r\n\r\n").find("Connection: close\r\n"), std::string::npos);
}

TEST(Port, TellsWhatIsWrongWithARequest) {
  EXPECT_TRUE(answer("GET / HTTP/1.1\r\nX: " + std::string(9000, 'x')).starts_with("HTTP/1.1 431"));
  EXPECT_TRUE(answer("GET / HTTP/1.1\r\nno colon\r\n\r\n").starts_with("HTTP/1.1 400"));
  EXPECT_TRUE(answer(std::string(3, '\0')).starts_with("HTTP/1.1 400"));
}

TEST(Port, ATakenAddressIsAnErrorThatNamesTheOption) {
  const Port first("--metrics", {"127.0.0.1", 0}, false, read);
  try {
    const Port second("--metrics", {"127.0.0.1", first.number()}, false, read);
    FAIL() << "it is taken";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("--metrics: 127.0.0.1:"), 0u) << error.what();
  }
}

}  // namespace
}  // namespace ziggurat::http
