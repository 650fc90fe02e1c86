#include "format/json_text.h"

#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>
#include <vector>

#include "base/error.h"

namespace synpo {
namespace {

using Json = nlohmann::json;

constexpr size_t kReasonLimit = 160;

// "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while parsing value - unexpected ..."
// from "while" on; "number overflow parsing '1e999'".
std::string reason_of(const std::string& what) {
  for (const char* mark : {"syntax error ", "parse error: ", "] "})
    if (const size_t at = what.find(mark); at != std::string::npos) return what.substr(at + std::string(mark).size());
  return what;
}

// Where the token stands that the parser quotes in its reason; 0 where it quotes none.
size_t byte_of_token(std::string_view text, const std::string& reason) {
  const size_t begin = reason.find('\''), end = reason.rfind('\'');
  if (begin == std::string::npos || end <= begin) return 0;
  const size_t at = text.find(std::string_view(reason).substr(begin + 1, end - begin - 1));
  return at == std::string_view::npos ? 0 : at + 1;
}

}  // namespace

Json parse_json(std::string_view text, const JsonLimits& limits) {
  std::vector<std::unordered_set<std::string>> names;  // of the objects that are open
  size_t values = 0;
  const auto look = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > limits.depth) fail(Exit::kData, "more than ", limits.depth, " levels of nesting");
    if (++values > limits.values) fail(Exit::kData, "more than ", limits.values, " values and names");
    if (event == Json::parse_event_t::object_start) names.emplace_back();
    if (event == Json::parse_event_t::object_end) names.pop_back();
    if (event == Json::parse_event_t::key && !names.back().insert(parsed.get_ref<const std::string&>()).second)
      fail(Exit::kData, "the name ", quoted(parsed.get_ref<const std::string&>()), " twice in one object");
    return true;
  };
  try {
    return Json::parse(text, look);
  } catch (const Json::parse_error& error) {
    fail(Exit::kData, "no JSON (byte ", error.byte, ": ", printable(reason_of(error.what()), kReasonLimit), ")");
  } catch (const Json::exception& error) {
    const std::string reason = reason_of(error.what());
    const size_t byte = byte_of_token(text, reason);
    fail(Exit::kData, "no JSON (", byte ? concat("byte ", byte, ": ") : "", printable(reason, kReasonLimit), ")");
  }
}

}  // namespace synpo
