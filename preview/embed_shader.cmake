# IN, a shader, as a C string in OUT: cmake -DIN=... -DOUT=... -P embed_shader.cmake
file(READ ${IN} text)
string(REPLACE "\\" "\\\\" text "${text}")
string(REPLACE "\"" "\\\"" text "${text}")
string(REGEX REPLACE "([^\n]*)\n" "\"\\1\\\\n\"\n" text "${text}")
file(WRITE ${OUT} "${text}")
