// File names in JSON, which must be Unicode text. A name on this system may be any bytes.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pprt {

// Returns the name as a string. One that is not UTF-8 becomes {"latin-1": "..."}, a character for each byte.
nlohmann::ordered_json json_name(const std::string& name);

// Returns the name again; nullopt if the value is none.
std::optional<std::string> name_in(const nlohmann::ordered_json& value);

}  // namespace pprt
