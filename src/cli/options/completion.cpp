#include "cli/options/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace pprt {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

std::string joined(const std::vector<OptionWord>& words) {
  std::vector<std::string> plain;
  for (const OptionWord& entry : words) plain.push_back(entry.word);
  return joined(plain);
}

// Returns the words, each followed by `tab` and its help in double quotes: zsh and fish show it beside the
// word.
std::string described(const std::vector<OptionWord>& words, std::string_view tab) {
  std::string text;
  for (const OptionWord& entry : words) {
    text += (text.empty() ? "" : " ") + entry.word;
    if (!entry.help.empty()) text += fmt::format("{}\"{}\"", tab, entry.help);
  }
  return text;
}

// Returns the description up to its first aside, as shells show one line.
std::string gist(const std::string& description) {
  return description.substr(
      0, std::min({description.find("; "), description.find(" ("), description.find(": ")}));
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
  return text;
}

// Escapes the text for single quotes of a POSIX-like shell.
std::string quotable(const std::string& text) {
  return replaced(text, "'", R"('\'')");
}

// Escapes the text for single quotes of fish.
std::string quotable_in_fish(const std::string& text) {
  return replaced(text, "'", R"(\')");
}

std::string function_name(const OptionTable& table) {
  return "_" + replaced(table.program, "-", "_");
}

std::vector<const OptionRow*> rows_of(const OptionTable& table, bool positional) {
  std::vector<const OptionRow*> rows;
  for (const OptionRow& row : table.rows) {
    if (row.positional == positional) rows.push_back(&row);
  }
  return rows;
}

std::vector<std::string> subcommand_names(const OptionTable& table) {
  std::vector<std::string> names;
  for (const OptionTable& subcommand : table.subcommands) names.push_back(subcommand.program);
  return names;
}

// Bash. The script splits the line itself: readline's words end at colons, which names of scenes contain.

std::string bash_assignments(const OptionRow& row) {
  switch (row.value) {
    case ValueKind::kChoice:
      return fmt::format("choices='{}'", joined(row.words));
    case ValueKind::kList:
      return fmt::format("list='{}'", joined(row.words));
    case ValueKind::kPath:
      return fmt::format("choices='{}' files=yes", joined(row.words));
    default:
      return ":";
  }
}

// Returns the cases that set the candidates at the cursor, by the word before it.
std::string bash_cases(const OptionTable& table, const std::string& indent) {
  std::string text = indent + "case $previous in\n";
  std::vector<std::string> names = subcommand_names(table);
  for (const OptionRow* row : rows_of(table, false)) {
    names.insert(names.end(), row->names.begin(), row->names.end());
    if (row->value == ValueKind::kNone) continue;
    text += fmt::format("{}  {}) {} ;;\n", indent, joined(row->names, " | "), bash_assignments(*row));
  }
  std::vector<std::string> words = subcommand_names(table);
  bool files = false;
  for (const OptionRow* row : rows_of(table, true)) {
    for (const OptionWord& entry : row->words) words.push_back(entry.word);
    files = files || row->value == ValueKind::kPath;
  }
  text += fmt::format("{}  *) if [[ $current == -* ]]; then choices='{}'; else choices='{}'{}; fi ;;\n",
                      indent, joined(names), joined(words), files ? " files=yes" : "");
  return text + indent + "esac\n";
}

std::string bash_script(const OptionTable& table) {
  std::string text = fmt::format("# bash completion of {}\n{}() {{\n", table.program, function_name(table));
  text += R"(  local line=${COMP_LINE:0:COMP_POINT} current previous choices= list= files=
  local -a words
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=('')
  current=${words[-1]} previous=${words[-2]}
  if [[ $current == --*=* ]]; then previous=${current%%=*} current=${current#*=}; fi
)";
  if (table.subcommands.empty()) {
    text += bash_cases(table, "  ");
  } else {
    text += "  case $((${#words[@]} > 2)):${words[1]} in\n";
    for (const OptionTable& subcommand : table.subcommands) {
      text += fmt::format("    1:{})\n{}      ;;\n", subcommand.program, bash_cases(subcommand, "      "));
    }
    text += fmt::format("    *)\n{}      ;;\n  esac\n", bash_cases(table, "      "));
  }
  text += R"(  local before=''
  if [[ -n $list ]]; then
    [[ $current == *,* ]] && before=${current%,*},
    choices=$list
    compopt -o nospace
  fi
  [[ -n $files ]] && compopt -o filenames
  mapfile -t COMPREPLY < <(
    compgen -P "$before" -W "$choices" -- "${current#"$before"}"
    [[ -z $files ]] || compgen -f -- "$current"
  )
  # Readline replaces only what stands behind the last colon.
  [[ $current == *:* && $COMP_WORDBREAKS == *:* ]] && COMPREPLY=("${COMPREPLY[@]#"${current%"${current##*:}"}"}")
  return 0
}
)";
  return text + fmt::format("complete -F {} {}\n", function_name(table), table.program);
}

// Zsh.

std::string zsh_action(const OptionRow& row) {
  switch (row.value) {
    case ValueKind::kChoice:
      return "((" + quotable(described(row.words, R"(\:)")) + "))";
    case ValueKind::kList:
      return fmt::format("_values -s , {} {}", row.label, joined(row.words));
    case ValueKind::kPath:
      if (row.words.empty()) return "_files";
      return fmt::format("{{ compadd -- {}; _files }}", replaced(joined(row.words), ":", R"(\:)"));
    default:
      return " ";
  }
}

std::string zsh_spec(const OptionRow& row) {
  const std::string value = fmt::format(":{}:{}", replaced(row.label, ":", R"(\:)"), zsh_action(row));
  if (row.positional) {
    return fmt::format("'{}:{}:{}'",
                       row.many       ? "*"
                       : row.required ? ""
                                      : ":",
                       row.names.front(), zsh_action(row));
  }
  std::string about = replaced(replaced(gist(row.description), "]", R"(\])"), ":", R"(\:)");
  about = quotable("[" + about + "]" + (row.value == ValueKind::kNone ? "" : value));
  if (row.names.size() == 1) return fmt::format("'*{}{}'", row.names.front(), about);
  return fmt::format("'*'{{{}}}'{}'", joined(row.names, ","), about);
}

std::string zsh_arguments(const OptionTable& table, const std::string& indent) {
  std::string text = indent + "_arguments -S";
  for (const OptionRow& row : table.rows) text += " \\\n" + indent + "  " + zsh_spec(row);
  return text + "\n";
}

std::string zsh_script(const OptionTable& table) {
  std::string text = fmt::format("#compdef {}\n", table.program);
  if (table.subcommands.empty()) return text + zsh_arguments(table, "");
  text += "if (( CURRENT == 2 )); then\n  local -a subcommands=(\n";
  for (const OptionTable& subcommand : table.subcommands) {
    text += fmt::format("    '{}:{}'\n", subcommand.program, quotable(subcommand.description));
  }
  text += "  )\n  _describe subcommand subcommands\n" + zsh_arguments(table, "  ");
  text += "else\n  shift words\n  (( CURRENT -= 1 ))\n  case $words[1] in\n";
  for (const OptionTable& subcommand : table.subcommands) {
    text += fmt::format("    {})\n{}      ;;\n", subcommand.program, zsh_arguments(subcommand, "      "));
  }
  return text + "  esac\nfi\n";
}

// Fish.

std::string fish_value(const OptionRow& row) {
  switch (row.value) {
    case ValueKind::kNone:
      return "";
    case ValueKind::kChoice:
      return fmt::format(" -x -a '{}'", quotable_in_fish(described(row.words, R"(\t)")));
    case ValueKind::kList:
      return fmt::format(" -x -a '(__fish_append , {})'", joined(row.words));
    case ValueKind::kPath:
      return row.words.empty() ? " -r -F" : fmt::format(" -r -F -a '{}'", joined(row.words));
    case ValueKind::kAny:
      break;
  }
  return " -x";
}

// `condition`: when the lines apply, for fish's -n.
std::string fish_lines(const OptionTable& table, const std::string& program, const std::string& condition) {
  const std::string head = "complete -c " + program + (condition.empty() ? "" : " -n '" + condition + "'");
  std::string text;
  for (const OptionRow& row : table.rows) {
    if (row.positional) {
      if (!row.words.empty()) text += fmt::format("{} -a '{}'\n", head, joined(row.words));
      continue;
    }
    text += head;
    for (const std::string& name : row.names) {
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    text += fish_value(row) + fmt::format(" -d '{}'\n", quotable_in_fish(gist(row.description)));
  }
  return text;
}

std::string fish_script(const OptionTable& table) {
  std::string text = fmt::format("# fish completion of {}\n", table.program);
  const bool commands = !table.subcommands.empty();
  text += fish_lines(table, table.program, commands ? "__fish_use_subcommand" : "");
  for (const OptionTable& subcommand : table.subcommands) {
    text += fmt::format("complete -c {} -n __fish_use_subcommand -f -a {} -d '{}'\n", table.program,
                        subcommand.program, quotable_in_fish(subcommand.description));
    text += fish_lines(subcommand, table.program, "__fish_seen_subcommand_from " + subcommand.program);
  }
  return text;
}

}  // namespace

std::string completion_script(const OptionTable& table, Shell shell) {
  switch (shell) {
    case Shell::kBash:
      return bash_script(table);
    case Shell::kZsh:
      return zsh_script(table);
    case Shell::kFish:
      break;
  }
  return fish_script(table);
}

}  // namespace pprt
