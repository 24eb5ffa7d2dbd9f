# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Writes the page into OUTPUT as one string of C++: MARKUP with STYLE and SCRIPT in their places. Literals of 16 kB, since
# longer ones are not portable.
file(READ ${MARKUP} page)
file(READ ${STYLE} style)
file(READ ${SCRIPT} script)
string(REPLACE "/*STYLE*/" "${style}" page "${page}")
string(FIND "${page}" "/*SCRIPT*/" at)
string(SUBSTRING "${page}" 0 ${at} before)
math(EXPR after_at "${at} + 10")
string(SUBSTRING "${page}" ${after_at} -1 after)
file(WRITE ${OUTPUT}.html "${before}")
file(APPEND ${OUTPUT}.html "${script}")
file(APPEND ${OUTPUT}.html "${after}")
file(READ ${OUTPUT}.html bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"tools/robot/view/http_page.hpp\"\n\nnamespace tread::view {\nnamespace {\nconst unsigned char kBytes[] = {\n${bytes}};\n}  // namespace\n\nstd::string_view pageText() {\n  return {reinterpret_cast<const char*>(kBytes), sizeof kBytes};\n}\n\n}  // namespace tread::view\n")
