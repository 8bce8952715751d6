"""Asks a served bench over pyvisa-py: tests/hw_serve/real_clients_test.cc."""

import sys

import pyvisa

bench = pyvisa.ResourceManager('@py').open_resource(sys.argv[1], read_termination='\n', write_termination='\n')
print(bench.query('*IDN?')[:22])
print(bench.query_ascii_values('ROT1:ANGL 5;SETT? 60;ANGL?', separator=';'))
bench.write('ROT1:ANGL 1e9')
print(bench.query('SYST:ERR?'))
