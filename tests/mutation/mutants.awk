# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Writes the mutants of a C++ file, one a line: number of the line, tab, that line with one rule removed or turned.
# A rule is taken from the text: conditions held true or false, operators and comparisons exchanged, entries of a table
# emptied or exchanged, constants doubled and halved, statements dropped.

function tell(line) { if (line != $0) print FNR "\t" line }

# Exchanges each place of a plain text, one at a time.
function exchange(from, to,    at, rest, before) {
  before = ""; rest = $0
  while ((at = index(rest, from)) > 0) {
    tell(before substr(rest, 1, at - 1) to substr(rest, at + length(from)))
    before = before substr(rest, 1, at + length(from) - 1)
    rest = substr(rest, at + length(from))
  }
}

# The same where the text ends the line.
function exchangeEnd(from, to,    n) {
  n = length($0) - length(from)
  if (n > 0 && substr($0, n + 1) == from) tell(substr($0, 1, n) to)
}

/^ *\/\// || /^#/ || /^namespace/ || /^ *(case|default)/ || /^ *return "[^"]*";$/ || /^ *$/ { next }

{
  if ($0 !~ /if \(const/) { exchange("if (", "if (true || "); exchange("if (", "if (false && ") }
  exchange(" ? ", " && false ? "); exchange(" ? ", " || true ? ")
  exchange(" && ", " || "); exchange(" || ", " && "); exchangeEnd(" &&", " ||"); exchangeEnd(" ||", " &&")
  exchange(" == ", " != "); exchange(" != ", " == ")
  exchange(" < ", " <= "); exchange(" < ", " >= "); exchange(" <= ", " < "); exchange(" <= ", " > ")
  exchange(" > ", " >= "); exchange(" > ", " <= "); exchange(" >= ", " > "); exchange(" >= ", " < ")
  if ($0 !~ /"/) { exchange(" + ", " - "); exchange(" - ", " + ") }
  exchange("(!", "("); exchange("return !", "return "); exchange("&& !", "&& "); exchange("|| !", "|| ")
  exchange("std::min(", "std::max("); exchange("std::max(", "std::min(")
  exchange("true", "false"); exchange("false", "true")
  exchange("std::all_of", "std::any_of")
  if ($0 ~ /constexpr .* = [0-9]/) { exchange(" = ", " = 2 * "); exchange(" = ", " = (1.0 / 2) * ") }
}

# An entry of a table of faults: emptied, then exchanged with its neighbour.
/\{State::/ {
  entries = $0
  while (match(entries, /in\.[a-z_]+\}/)) {
    entry = substr(entries, RSTART, RLENGTH)
    exchange(entry, "\"\"}")
    entries = substr(entries, RSTART + RLENGTH)
  }
  if (match($0, /\{State::[^{}]*\}, +\{State::[^{}]*\}/)) {
    pair = substr($0, RSTART, RLENGTH); cut = index(pair, "},")
    tell(substr($0, 1, RSTART - 1) substr(pair, cut + 2) ", " substr(pair, 1, cut) substr($0, RSTART + RLENGTH))
  }
  exchange("State::kFault", "State::kDisarmed"); exchange("State::kDisarmed", "State::kFault")
}

# A statement of its own: dropped.
/^  +[a-z_.+*]+[^{}]*;$/ && !/^ *(return|const|using|State|auto|Fault|std::|FailsafeOutputs|Admission|ProgramGate)/ && !/^ *[A-Za-z_:<>0-9]+ [a-z_]+( =|;)/ {
  opened = gsub(/\(/, "("); closed = gsub(/\)/, ")")
  if (opened == closed) tell("  ;")
}
