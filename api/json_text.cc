#include "api/json_text.h"

#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/names.h"

namespace anchord {
namespace {

using nlohmann::json;

/// Builds a value from what nlohmann's parser reports, and ends the parsing at the first thing that
/// is refused. (The parser's own filter takes quadratic time: it searches the whole enclosing array
/// for discarded elements after each.)
class Builder : public json::json_sax_t {
 public:
  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(std::int64_t value) override { return add(value); }
  bool number_unsigned(std::uint64_t value) override { return add(value); }
  bool number_float(double value, const std::string& /*text*/) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(json::binary_t& /*value*/) override { return refuse("binary data is no JSON text"); }

  bool start_object(std::size_t /*size*/) override { return open(json::object()); }
  bool key(std::string& name) override {
    if (open_.back()->contains(name)) {
      return refuse("an object of the JSON text names a member twice");
    }
    key_ = std::move(name);
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*size*/) override { return open(json::array()); }
  bool end_array() override { return close(); }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const json::exception& error) override {
    constexpr int kNumberOverflow = 406;  // nlohmann: out_of_range.406
    const std::string at = " at byte " + std::to_string(position);
    return refuse(error.id == kNumberOverflow ? "a number is out of range" + at
                                              : "not valid JSON" + at);
  }

  Result<json> take() {
    if (!refusal_.empty()) return invalid("", refusal_);
    return std::move(root_);
  }

 private:
  bool refuse(std::string message) {
    refusal_ = std::move(message);
    return false;
  }

  json& place(json value) {
    if (open_.empty()) return root_ = std::move(value);
    json& parent = *open_.back();
    if (parent.is_object()) return parent[key_] = std::move(value);
    parent.push_back(std::move(value));
    return parent.back();
  }

  bool add(json value) {
    place(std::move(value));
    return true;
  }

  bool open(json value) {
    if (open_.size() == kMaxJsonDepth) return refuse("the JSON text is nested too deeply");
    open_.push_back(&place(std::move(value)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  json root_;
  std::vector<json*> open_;  ///< from the outermost; an array grows only while it is the last
  std::string key_;
  std::string refusal_;
};

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text) {
  if (text.size() > kMaxMessageBytes) {
    return Error{ErrorCode::kTooLarge, "", "the JSON text has more than 8 MiB"};
  }
  Builder builder;
  json::sax_parse(text, &builder);
  return builder.take();
}

}  // namespace anchord
