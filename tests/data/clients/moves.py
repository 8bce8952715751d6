"""Drives both axes of a served bench through PyMeasure's own driver of the ESP300: tests/hw_serve/real_clients_test.cc.

Of 30.123456 deg that driver sends six digits: what the table has is what the encoder says.
"""

import sys

from pymeasure.instruments.newport import ESP300

e = ESP300(sys.argv[1], visa_library='@py', read_termination='\r\n', write_termination='\r')
e.clear_errors()
e.x.enable()
e.x.units = 'degree'
print(e.x.enabled, e.x.units)
e.x.position = 30.123456
e.x.wait_for_stop()
print(e.x.position, e.y.position)
e.x.right_limit = 45
e.x.position = 46
print([str(x) for x in e.errors], e.x.right_limit)
e.x.define_position(0)
e.phi.enable()
print([x.error for x in e.errors])
e.shutdown()
print(e.x.enabled, e.id[:6])
