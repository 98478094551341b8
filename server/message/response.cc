#include "server/message/response.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace milepost::server {
namespace {

std::string title_of(unsigned status) {
  switch (status) {
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 410:
      return "Gone";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 416:
      return "Range Not Satisfiable";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "Internal Server Error";
  }
}

unsigned status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::invalid_input:
      return 400;
    case ErrorCode::not_found:
      return 404;
    case ErrorCode::gone:
      return 410;
    case ErrorCode::unavailable:
    case ErrorCode::cancelled:
      return 503;
    case ErrorCode::corrupt:
    case ErrorCode::io:
      break;
  }
  return 500;
}

template <class Entry>
std::uint64_t bytes_of(const std::vector<const Entry*>& entries) {
  std::uint64_t bytes = 0;
  for (const Entry* entry : entries) bytes += entry->bytes;
  return bytes;
}

}  // namespace

std::string_view Response::header(std::string_view name) const {
  const auto found = std::find_if(headers.begin(), headers.end(),
                                  [name](const auto& header) { return header.first == name; });
  return found == headers.end() ? std::string_view() : found->second;
}

std::uint64_t Response::content_length() const {
  if (part) return part->bytes;
  if (const auto* text = std::get_if<SharedText>(&body)) return *text ? (*text)->size() : 0;
  if (const auto* list = std::get_if<TileList>(&body)) return bytes_of(list->tiles);
  return bytes_of(std::get<CellList>(body).cells);
}

SharedText shared_text(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

Response problem(unsigned status, const std::string& detail) {
  const nlohmann::ordered_json json = {
      {"type", "about:blank"}, {"title", title_of(status)}, {"status", status}, {"detail", detail}};
  Response response;
  response.status = status;
  response.headers = {{"Content-Type", "application/problem+json"}, {"Cache-Control", "no-store"}};
  if (status == 503) response.headers.emplace_back("Retry-After", "1");
  // The detail may quote bytes of the request that are not valid UTF-8.
  response.body = shared_text(
      json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  return response;
}

std::string problem_detail(const Response& response) {
  return nlohmann::json::parse(*std::get<SharedText>(response.body)).at("detail");
}

Response problem(const Error& error) { return problem(status_of(error.code), error.line()); }

}  // namespace milepost::server
