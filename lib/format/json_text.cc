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

// Looks at a text before anything is made of it, in a time that grows with its length alone.
class Inspector : public nlohmann::json_sax<Json> {
 public:
  explicit Inspector(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return count(); }
  bool boolean(bool) override { return count(); }
  bool number_integer(number_integer_t) override { return count(); }
  bool number_unsigned(number_unsigned_t) override { return count(); }
  bool number_float(number_float_t, const string_t&) override { return count(); }
  bool string(string_t&) override { return count(); }
  bool binary(binary_t&) override { return count(); }
  bool start_object(size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (!names_.back().insert(name).second) fail(Exit::kData, "the name ", synpo::quoted(name), " twice in one object");
    return count();
  }
  // The parser proper will say it.
  bool parse_error(size_t, const std::string&, const Json::exception&) override { return false; }

 private:
  bool count() {
    if (int(names_.size()) > limits_.depth) fail(Exit::kData, "more than ", limits_.depth, " levels of nesting");
    if (++values_ > limits_.values) fail(Exit::kData, "more than ", limits_.values, " values and names");
    return true;
  }
  bool open() {
    count();
    names_.emplace_back();
    return true;
  }
  bool close() {
    names_.pop_back();
    return count();
  }

  JsonLimits limits_;
  std::vector<std::unordered_set<std::string>> names_;  // of the objects and arrays that are open
  size_t values_ = 0;
};

}  // namespace

Json parse_json(std::string_view text, const JsonLimits& limits) {
  // The parser takes it for the end.
  if (const size_t at = text.find('\0'); at != std::string_view::npos)
    fail(Exit::kData, "no JSON (byte ", at + 1, ": a NUL byte)");
  Inspector inspector(limits);
  Json::sax_parse(text, &inspector);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    fail(Exit::kData, "no JSON (byte ", error.byte, ": ", printable(reason_of(error.what()), kReasonLimit), ")");
  } catch (const Json::exception& error) {
    const std::string reason = reason_of(error.what());
    const size_t byte = byte_of_token(text, reason);
    fail(Exit::kData, "no JSON (", byte ? concat("byte ", byte, ": ") : "", printable(reason, kReasonLimit), ")");
  }
}

}  // namespace synpo
