# SPDX-License-Identifier: MIT
"""The kit refuses the same JSON of clients as a server: the texts of json_test.cpp, and more."""

import unittest

from ziggurat_conformance.case import Failed
from ziggurat_conformance.client_bytes import client_message


def _hello(fields: str) -> str:
    return '{"hello":{"version":{"major":1},"role":"ROLE_CONTROLLER",%s}}' % fields


def _nested(levels: int) -> str:
    return '{"later":' + "[" * levels + "]" * levels + ',"heartbeat":{}}'


RIGHT = [
    _hello('"robots":["*"],"later":{"a":[1,[true,null],{"robots":"*"}],"a":"\\u00e9"}'),
    _nested(63),
    '{"command":{"tick":7,"joint_targets":["1.5",2,"NaN","-1e-3"],"colour":[{"x":null}],"log":null}}',
    '{"command":{"tick":"7","turretModes":["TURRET_SPEED",1,"2"],"tagPayloads":["","YQ==","YQ","_-8="]}}',
    '{"leave":{"reason":1,"message":"\\ud83d\\ude00"}}',
    '{"command":{"tick":7.0},"leave":null}',
    '{"myNote":1,"heartbeat":{"later":1,"later":2},"myNote":2}',
    '{"command":{"jointTargets":["0e-999","-0.0",5e-324,"5e-324"],"turretModes":[-2147483648,2147483647]}}',
]
WRONG = [
    "[]", '{"hello":', "{}{}", "{'hello':{}}", "{hello:{}}", '{"hello":7}', '{"leave":"DONE"}',
    _hello('"robots":["*",]'), _hello('"robots":["*"],"x":+1'), _hello('"robots":["*"],"x":01'),
    _hello('"robots":["*"],"x":1e400'), _hello('"robots":["*"],"x":"\\ud800"'), _hello('"robots":["*"],"x":"a\nb"'),
    _hello('"robots":"*"'), _hello('"robots":[["*"]]'), _hello('"robots":["*",null]'), _hello('"robots":[7]'),
    _hello('"robots":{"0":"*"}'), _hello('"robots":["*"],"takeover":"true"'), _hello('"robots":["*"],"takeover":1'),
    _hello('"robots":["*"],"clientName":["me"]'), _hello('"robots":["*"],"robots":["x"]'),
    _hello('"robots":["*"],"clientName":"a","client_name":"b"'), _hello('"deadlinePolicy":{"action":"STOPP"}'),
    _nested(64), _nested(5000),
    '{"command":{"jointTargets":[true]}}', '{"command":{"jointTargets":[" 1"]}}', '{"command":{"jointTargets":["1_0"]}}',
    '{"command":{"jointTargets":["inf"]}}', '{"command":{"jointTargets":["1e400"]}}', '{"command":{"log":{"text":"one"}}}',
    '{"command":[{"tick":"0"}]}', '{"command":{"tick":"+1"}}', '{"command":{"tick":1.5}}', '{"command":{"tick":true}}',
    '{"command":{"jointTargets":["1e-400"]}}', '{"command":{"turretModes":[2147483648]}}', '{"hello":{"role":4294967297}}',
    '{"command":{"turretModes":[1.5]}}', '{"command":{"turretModes":["FAST"]}}',
    '{"command":{"rangeAndBearingData":"!!!"}}', '{"command":{"rangeAndBearingData":"A"}}',
    '{"command":{"rangeAndBearingData":"AB=="}}', '{"command":{"rangeAndBearingData":"YQ="}}',
    '{"command":{"rangeAndBearingData":5}}',
]


class ClientText(unittest.TestCase):
    def test_what_a_server_takes_is_right(self):
        for text in RIGHT:
            with self.subTest(text):
                client_message(text.encode())

    def test_what_a_server_refuses_is_wrong(self):
        for text in WRONG:
            with self.subTest(text[:80]):
                with self.assertRaises(Failed):
                    client_message(text.encode())


if __name__ == "__main__":
    unittest.main()
