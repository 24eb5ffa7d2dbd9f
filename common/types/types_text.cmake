# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026 The Tread authors
# Writes the .lcm files of each of FOLDERS into OUTPUT as strings of C++, one a folder, one raw literal a file: NAME is
# the array of them.
string(REPLACE "," ";" folders "${FOLDERS}")
set(text "namespace tread {\nextern const char* const ${NAME}[];\nconst char* const ${NAME}[] = {\n")
foreach(folder IN LISTS folders)
  file(GLOB files ${folder}/*_t.lcm)
  list(SORT files)
  foreach(file IN LISTS files)
    file(READ ${file} content)
    string(APPEND text "R\"lcm(${content})lcm\"\n")
  endforeach()
  string(APPEND text ",\n")
endforeach()
file(WRITE ${OUTPUT} "${text}nullptr};\n}  // namespace tread\n")
