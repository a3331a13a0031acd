# SPDX-License-Identifier: MIT
# Serves vehicle.argos for two seconds with the options of settings.toml.
ziggurat keygen --out server
ziggurat keygen --out alice
echo "$(cat alice.public) controller" > clients.txt
code=0
timeout --signal INT 2 ziggurat serve vehicle.argos --settings settings.toml --endpoint "ipc://$PWD/socket" || code=$?
[ "$code" = 124 ]
