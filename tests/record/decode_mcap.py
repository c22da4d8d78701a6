"""Decodes every message of an .mcap with nothing but what is in the file; a test runs it, and so may anybody.

    pip install mcap mcap-protobuf-support
    python tests/record/decode_mcap.py FILE...
"""

import sys
from collections import Counter

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

for path in sys.argv[1:]:
    counts, energies, contacts = Counter(), [], Counter()
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            counts[f"{channel.topic} ({schema.name})"] += 1
            if channel.topic == "/energy":
                energies.append(decoded)
            if channel.topic == "/contacts":
                contacts[len(decoded.contacts)] += 1
        print(path)
        for metadata in reader.iter_metadata():
            print(f"  {metadata.name}: {metadata.metadata}")
        for attachment in reader.iter_attachments():
            print(f"  attached: {attachment.name}, {len(attachment.data)} bytes")
    for topic, count in sorted(counts.items()):
        print(f"  {count:8} {topic}")
    if contacts:
        print(f"  samples by number of contacts: {dict(sorted(contacts.items()))}")
    for label, energy in [("first", energies[0]), ("last", energies[-1])] if energies else []:
        print(
            f"  {label}: step {energy.step}, t = {energy.time_s!r} s, kinetic {energy.kinetic_j!r} J, "
            f"potential {energy.potential_j!r} J, total {energy.total_j!r} J, penetration {energy.penetration_m!r} m"
        )
