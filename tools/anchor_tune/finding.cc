#include "tools/anchor_tune/finding.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

namespace anchord::tuning {
namespace {

using nlohmann::json;

constexpr std::size_t kWidth = 100;
/// The order of a configuration's sections; others come after them.
constexpr std::array kSections = {"world",   "places",  "attributes", "classes",
                                  "sensors", "default", "hypotheses", "maintenance"};

std::size_t rank(const std::string& key) {
  return static_cast<std::size_t>(std::find(kSections.begin(), kSections.end(), key) -
                                  kSections.begin());
}

/// On one line, with spaces.
std::string in_line(const json& v) {
  if (!v.is_structured()) return v.dump();
  std::string text;
  for (const auto& [key, member] : v.items())
    text += (text.empty() ? "" : ", ") + (v.is_object() ? json(key).dump() + ": " : "") +
            in_line(member);
  return v.is_object() ? "{" + text + "}" : "[" + text + "]";
}

class Printer {
 public:
  explicit Printer(const Findings& findings) {
    for (const Finding& f : findings) {
      if (f.path.empty())
        remarks_.push_back(f.why);
      else if (!f.why.empty())
        why_[f.path.to_string()] = f.why;
    }
  }

  std::string print(const json& document, const std::string& title) {
    comment(title, "");
    for (const std::string& remark : remarks_) comment("- " + remark, "");
    value(document, JsonPath(), "", 0);
    out_ << '\n';
    return out_.str();
  }

 private:
  void comment(const std::string& text, const std::string& indent) {
    std::istringstream words(text);
    std::string line, word;
    while (words >> word) {
      if (!line.empty() && indent.size() + 4 + line.size() + word.size() > kWidth) {
        out_ << indent << "// " << line << '\n';
        line.clear();
      }
      line += (line.empty() ? "" : " ") + word;
    }
    if (!line.empty()) out_ << indent << "// " << line << '\n';
  }

  bool commented_below(const std::string& path) const {
    const auto it = why_.upper_bound(path + "/");
    return it != why_.end() && it->first.starts_with(path + "/");
  }

  /// `used`: what stands before it on its line.
  void value(const json& v, const JsonPath& path, const std::string& indent, std::size_t used) {
    const std::string whole = in_line(v);
    const bool simple = !v.is_structured() || v.empty();
    if (simple || (!commented_below(path.to_string()) && used + whole.size() + 1 <= kWidth &&
                   !path.empty())) {
      out_ << whole;
      return;
    }
    const std::string inner = indent + "  ";
    out_ << (v.is_object() ? "{\n" : "[\n");
    std::vector<std::string> keys;
    if (v.is_object())
      for (const auto& [key, unused] : v.items()) keys.push_back(key);
    std::stable_sort(keys.begin(), keys.end(),
                     [](const auto& a, const auto& b) { return rank(a) < rank(b); });
    for (std::size_t i = 0; i < v.size(); ++i) {
      const JsonPath at = v.is_object() ? path / keys[i] : path / i;
      if (const auto why = why_.find(at.to_string()); why != why_.end())
        comment(why->second, inner);
      const std::string name = v.is_object() ? json(keys[i]).dump() + ": " : "";
      out_ << inner << name;
      value(v.is_object() ? v[keys[i]] : v[i], at, inner, inner.size() + name.size());
      out_ << (i + 1 < v.size() ? ",\n" : "\n");
    }
    out_ << indent << (v.is_object() ? '}' : ']');
  }

  std::vector<std::string> remarks_;
  std::map<std::string, std::string> why_;
  std::ostringstream out_;
};

/// A number, or one's dependence on the distance, that is to get members by name stands for all
/// that are not named, as configurations read it.
void set(json& document, const JsonPath& path, const json& value) {
  const JsonPath above = path.parent_pointer();
  const bool index = std::isdigit(static_cast<unsigned char>(path.back().front()));
  if (!above.empty() && document.contains(above) &&
      (document[above].is_number() || (document[above].is_array() && !index)))
    document[above] = {{"default", document[above]}};
  document[path] = value;
}

void erase(json& document, const JsonPath& path) {
  if (!document.contains(path)) return;
  json& parent = document[path.parent_pointer()];
  if (parent.is_object()) parent.erase(path.back());
}

}  // namespace

std::string dotted(const JsonPath& path) {
  std::string text = path.to_string();
  std::replace(text.begin(), text.end(), '/', '.');
  return text.empty() ? text : text.substr(1);
}

json number(double value) {
  if (value > 0.999 && value < 1) return 1 - number(1 - value).get<double>();
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return std::strtod(text, nullptr);
}

Finding estimated(JsonPath path, const Estimate& estimate, const std::string& how,
                  const std::string& more) {
  return {std::move(path), number(estimate.value), how + ": " + estimate.text() + "." + more,
          estimate};
}

std::string tuned_text(json base, const Findings& findings, const std::string& title) {
  for (const Finding& f : findings) {
    if (f.path.empty()) continue;
    if (f.value.is_null())
      erase(base, f.path);
    else
      set(base, f.path, f.value);
  }
  return Printer(findings).print(base, title);
}

std::string report_text(const Findings& findings) {
  std::string text;
  for (const Finding& f : findings) {
    if (f.why.empty()) continue;
    text += dotted(f.path);
    if (f.value.is_primitive() && !f.value.is_null()) text += " " + f.value.dump();
    text += (f.path.empty() ? "" : ": ") + f.why + "\n";
  }
  return text;
}

}  // namespace anchord::tuning
