#include "tests/server/responses.h"

#include <gtest/gtest.h>

namespace milepost::server {

std::string text_of(const Response& response) {
  const auto& text = std::get<SharedText>(response.body);
  return text ? *text : std::string();
}

nlohmann::json json_of(const Response& response) {
  EXPECT_EQ(response.header("Content-Type"), "application/json");
  return nlohmann::json::parse(text_of(response));
}

unsigned problem_status(const Response& response) {
  EXPECT_EQ(response.header("Content-Type"), "application/problem+json");
  EXPECT_EQ(response.header("Cache-Control"), "no-store");
  EXPECT_EQ(response.header("ETag"), "");
  const nlohmann::json problem = nlohmann::json::parse(text_of(response));
  EXPECT_EQ(problem.at("status"), response.status);
  EXPECT_EQ(problem.at("type"), "about:blank");
  EXPECT_FALSE(problem.at("title").get<std::string>().empty());
  EXPECT_FALSE(problem.at("detail").get<std::string>().empty());
  return response.status;
}

std::string detail_of(const Response& response) {
  return nlohmann::json::parse(text_of(response)).at("detail");
}

}  // namespace milepost::server
