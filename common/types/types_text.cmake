# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Writes all .lcm files of FOLDER into OUTPUT as one string of C++, one raw literal a file.
file(GLOB files ${FOLDER}/*_t.lcm)
list(SORT files)
set(text "namespace tread {\nextern const char* const kTypesText;\nconst char* const kTypesText =\n")
foreach(file IN LISTS files)
  file(READ ${file} content)
  string(APPEND text "R\"lcm(${content})lcm\"\n")
endforeach()
file(WRITE ${OUTPUT} "${text};\n}  // namespace tread\n")
