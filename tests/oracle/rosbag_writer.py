"""What the scripts that write logs with PyPI's rosbags have in common."""


def write(writer, messages, serialize, store):
    """Writes messages, each a time in nanoseconds, a topic, a type and a message, in their order."""
    connections = {}
    with writer:
        for time, topic, kind, message in messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], time, serialize(message, kind))
