read line; echo 'list index out of range' >&2; exit 3
