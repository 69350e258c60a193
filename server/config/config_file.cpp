#include "server/config/config_file.h"

#include <algorithm>
#include <set>

namespace pmesh {
namespace {

/// nlohmann's events of one flat object. False ends the parsing, with the error set.
class FlatObject : public nlohmann::json_sax<SettingValue> {
 public:
  std::vector<NamedValue> members;
  Error error;

  bool null() override { return take(nullptr); }
  bool boolean(bool value) override { return take(value); }
  bool number_integer(number_integer_t value) override { return take(value); }
  bool number_unsigned(number_unsigned_t value) override { return take(value); }
  bool number_float(number_float_t value, const string_t&) override { return take(value); }
  bool string(string_t& value) override { return take(std::move(value)); }
  bool binary(binary_t&) override { return refuse("a binary value"); }

  bool start_object(std::size_t) override {
    if (is_open_) return refuse_nesting();
    is_open_ = true;
    return true;
  }
  bool key(string_t& name) override {
    if (!names_.insert(name).second) return refuse(shown(name) + " comes twice");
    members.emplace_back(std::move(name), nullptr);
    return true;
  }
  bool end_object() override { return true; }

  bool start_array(std::size_t) override {
    if (!is_open_) return refuse("expected a JSON object");
    if (in_list_) return refuse_nesting();
    in_list_ = true;
    members.back().second = SettingValue::array();
    return true;
  }
  bool end_array() override {
    in_list_ = false;
    return true;
  }

  bool parse_error(std::size_t, const std::string&,
                   const nlohmann::detail::exception& fault) override {
    const std::string_view text = fault.what();  // "[json.exception.parse_error.101] parse error"
    return refuse(std::string(text.substr(std::min(text.size(), text.find("] ") + 2))));
  }

 private:
  bool take(SettingValue value) {
    if (!is_open_) return refuse("expected a JSON object");
    if (in_list_) {
      members.back().second.push_back(std::move(value));
    } else {
      members.back().second = std::move(value);
    }
    return true;
  }

  bool refuse_nesting() {
    return refuse(shown(members.back().first) + ": expected a single value or a list of them");
  }

  bool refuse(std::string message) {
    error = {ErrorCode::usage, std::move(message)};
    return false;
  }

  std::set<std::string> names_;
  bool is_open_ = false;
  bool in_list_ = false;
};

}  // namespace

Result<std::vector<NamedValue>> parse_config(std::string_view text) {
  if (text.size() > kMaxConfigBytes) return Error{ErrorCode::usage, "is larger than 1 MiB"};
  FlatObject object;
  if (!SettingValue::sax_parse(text, &object)) return object.error;
  return std::move(object.members);
}

}  // namespace pmesh
