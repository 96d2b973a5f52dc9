# SPDX-License-Identifier: MPL-2.0
# cmake -DPROGRAM=FILE -DPAGE=FILE -P printed_in.cmake: fails unless the page shows what the program prints.
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(READ ${PAGE} page)
string(FIND "${page}" "```text\n${printed}```" place)
if(place EQUAL -1)
  message(FATAL_ERROR "${PAGE} does not show what ${PROGRAM} prints:\n${printed}")
endif()
