# keep.py STOPS READINGS COLUMNS: keeps what it was told as plan.csv, and reads 0.25 in every column at every stop.
import shutil
import sys

shutil.copy(sys.argv[1], 'plan.csv')
lines = open(sys.argv[1]).read().splitlines()
at = lines[0].split(',').index('reading')
with open(sys.argv[2], 'w') as out:
    print('reading,' + sys.argv[3], file=out)
    for line in lines[1:]:
        print(line.split(',')[at] + ',0.25' * len(sys.argv[3].split(',')), file=out)
