use std::{
    io::{ErrorKind, Read, Write},
    net::Ipv4Addr,
    sync::Mutex,
    thread::JoinHandle,
};

use super::*;

type Streams = Vec<Option<TcpStream>>;

/// Addresses of this machine that nobody uses.
fn hosts(processes: usize) -> Hosts {
    let bind = |_| TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let free: Vec<_> = (0..processes).map(bind).collect();
    let addresses = free.iter().map(|free| format!("{}\n", free.local_addr().unwrap()));
    Hosts::parse(&addresses.collect::<String>()).unwrap()
}

/// Connects a process, in a thread of its own.
fn connect_within(
    hosts: &Hosts,
    process: usize,
    patience: Duration,
) -> JoinHandle<Result<Streams, ConnectError>> {
    let hosts = hosts.clone();
    thread::spawn(move || {
        let waiting = |_: &[String]| {};
        let (hosts, waiting) = (&hosts, &waiting);
        Connector { hosts, process, settings: &[], watch: &(), waiting, patience }.connect()
    })
}

fn connect(hosts: &Hosts, process: usize) -> JoinHandle<Result<Streams, ConnectError>> {
    connect_within(hosts, process, Duration::from_secs(60))
}

/// A stream to a process that may not listen yet.
fn dial(hosts: &Hosts, process: usize) -> TcpStream {
    loop {
        if let Ok(stream) = TcpStream::connect(hosts.address(process)) {
            stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
            return stream;
        }
        thread::sleep(Duration::from_millis(10));
    }
}

fn greeting(process: usize) -> Vec<u8> {
    Greeting { process, settings: Vec::new() }.message().unwrap()
}

/// Reads the greeting of a process that has no settings.
fn read_greeting(stream: &mut TcpStream, process: usize) {
    let mut greeted = vec![0; greeting(process).len()];
    stream.read_exact(&mut greeted).unwrap();
    assert_eq!(greeted, greeting(process));
}

/// A whole handshake of `process`, which calls process 0.
fn confirmed(hosts: &Hosts, process: usize) -> TcpStream {
    let mut stream = dial(hosts, 0);
    stream.write_all(&greeting(process)).unwrap();
    read_greeting(&mut stream, 0);
    stream.write_all(b"+").unwrap();
    let mut answer = [0];
    stream.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"+");
    stream
}

/// Checks that the processes are connected to each other: what each sends arrives.
fn assert_connected(connected: Vec<JoinHandle<Result<Streams, ConnectError>>>) {
    let all: Vec<Streams> = connected.into_iter().map(|of| of.join().unwrap().unwrap()).collect();
    for (from, to) in (0..all.len()).flat_map(|from| (0..all.len()).map(move |to| (from, to))) {
        assert_eq!(all[from][to].is_none(), from == to);
        let (Some(mut sender), Some(mut receiver)) =
            (all[from][to].as_ref(), all[to][from].as_ref())
        else {
            continue;
        };
        receiver.set_nonblocking(false).unwrap();
        receiver.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
        sender.write_all(&[from as u8, to as u8]).unwrap();
        let mut received = [0; 2];
        receiver.read_exact(&mut received).unwrap();
        assert_eq!(received, [from as u8, to as u8]);
    }
}

/// It is lost, which the work notices. It is not waited for: it has ended, and does not come back.
#[test]
fn a_process_that_ends_when_all_are_connected_is_not_waited_for() {
    let hosts = hosts(2);
    let listener = TcpListener::bind(hosts.address(0)).unwrap();
    let second = connect_within(&hosts, 1, Duration::from_secs(5));
    let (mut stream, _) = listener.accept().unwrap();
    read_greeting(&mut stream, 1);
    stream.write_all(&greeting(0)).unwrap();
    let mut confirmation = [0];
    stream.read_exact(&mut confirmation).unwrap();
    stream.write_all(&confirmation).unwrap();
    drop((stream, listener));
    assert!(second.join().unwrap().unwrap()[0].is_some());
}

#[test]
fn strangers_that_send_nothing_delay_nobody() {
    let hosts = hosts(3);
    let first = connect(&hosts, 0);
    let _strangers: Vec<_> = (0..20).map(|_| dial(&hosts, 0)).collect();
    let begun = Instant::now();
    assert_connected(vec![first, connect(&hosts, 1), connect(&hosts, 2)]);
    assert!(begun.elapsed() < Duration::from_secs(4), "{:?}", begun.elapsed());
}

#[test]
fn a_slow_stranger_delays_nobody_and_is_given_up() {
    let hosts = hosts(2);
    let first = connect(&hosts, 0);
    let mut slow = dial(&hosts, 0);
    let begun = Instant::now();
    // Each byte comes soon enough, and all of them would take 20 seconds.
    let sent = thread::spawn(move || {
        for byte in greeting(1).iter().cycle().take(100) {
            if slow.write_all(&[*byte]).is_err() {
                break;
            }
            thread::sleep(Duration::from_millis(200));
        }
        begun.elapsed()
    });
    // Past the time of a handshake.
    let sent = sent.join().unwrap();
    assert!(sent < Duration::from_secs(8), "{sent:?}");
    let mut slow = dial(&hosts, 0);
    slow.write_all(b"topo").unwrap();
    let begun = Instant::now();
    assert_connected(vec![first, connect(&hosts, 1)]);
    assert!(begun.elapsed() < Duration::from_secs(4), "{:?}", begun.elapsed());
}

/// A process that gives up a call, and calls again: its packets were lost, or it was started again.
#[test]
fn the_last_stream_of_a_process_counts() {
    let hosts = hosts(3);
    let first = connect(&hosts, 0);
    let mut given_up = dial(&hosts, 0);
    given_up.write_all(&greeting(1)).unwrap();
    read_greeting(&mut given_up, 0);
    let _lost = confirmed(&hosts, 1);
    let second = connect(&hosts, 1);
    thread::sleep(Duration::from_millis(500));
    assert_connected(vec![first, second, connect(&hosts, 2)]);
}

#[test]
fn a_stream_counts_for_the_caller_only_when_it_is_confirmed() {
    let hosts = hosts(2);
    let listener = TcpListener::bind(hosts.address(0)).unwrap();
    let second = connect(&hosts, 1);
    let answer = |message: &[u8]| {
        let (mut stream, _) = listener.accept().unwrap();
        stream.write_all(&greeting(0)).unwrap();
        read_greeting(&mut stream, 1);
        let mut answer = [0];
        stream.read_exact(&mut answer).unwrap();
        assert_eq!(&answer, b"+");
        stream.write_all(message).unwrap();
        stream
    };
    drop(answer(b""));
    drop(answer(b"-"));
    // What follows the confirmation belongs to the work.
    let _last = answer(b"+work");
    let stream = second.join().unwrap().unwrap().remove(0).unwrap();
    stream.set_nonblocking(false).unwrap();
    let mut work = [0; 4];
    (&stream).read_exact(&mut work).unwrap();
    assert_eq!(&work, b"work");
}

#[test]
fn a_process_that_is_killed_is_waited_for_again() {
    let hosts = hosts(3);
    let named = Mutex::new(Vec::new());
    thread::scope(|scope| {
        let first = scope.spawn(|| {
            let waiting = |names: &[String]| named.lock().unwrap().push(names.to_vec());
            let (settings, patience) = (&[], Duration::from_secs(60));
            let (hosts, waiting) = (&hosts, &waiting);
            Connector { hosts, process: 0, settings, watch: &(), waiting, patience }.connect()
        });
        let killed = confirmed(&hosts, 1);
        while named.lock().unwrap().is_empty() {
            thread::sleep(Duration::from_millis(10));
        }
        drop(killed);
        while named.lock().unwrap().len() < 2 {
            thread::sleep(Duration::from_millis(10));
        }
        let others = [connect(&hosts, 1), connect(&hosts, 2)];
        let first = first.join().unwrap();
        let first = thread::spawn(|| first);
        assert_connected([first].into_iter().chain(others).collect());
    });
    let all = [vec![hosts.name(2)], vec![hosts.name(1), hosts.name(2)]];
    assert_eq!(*named.lock().unwrap(), all);
}

#[test]
fn the_time_of_the_whole_start_is_limited_for_those_that_call_and_those_that_are_called() {
    let hosts = hosts(2);
    for process in [0, 1] {
        let begun = Instant::now();
        let end = connect_within(&hosts, process, Duration::from_secs(1));
        // Those that call process 0, and the server at its address: they never send anything.
        let _silent = if process == 0 {
            (vec![dial(&hosts, 0), dial(&hosts, 0)], None)
        } else {
            (Vec::new(), Some(TcpListener::bind(hosts.address(0)).unwrap()))
        };
        let end = end.join().unwrap();
        let missing = [hosts.name(1 - process)];
        assert!(
            matches!(&end, Err(ConnectError::Missing { names }) if *names == missing),
            "{end:?}"
        );
        assert!(begun.elapsed() < Duration::from_secs(3), "{:?}", begun.elapsed());
    }
}

#[test]
fn a_greeting_that_is_none_ends_its_stream_only() {
    let hosts = hosts(2);
    let first = connect(&hosts, 0);
    let too_long = [b"toposlam".as_slice(), &u32::MAX.to_be_bytes()].concat();
    let no_json = b"toposlam\0\0\0\x02[}".to_vec();
    for wrong in [b"GET / HTTP/1.1\r\n".to_vec(), too_long, no_json, greeting(0), greeting(2)] {
        let mut stranger = dial(&hosts, 0);
        stranger.write_all(&wrong).unwrap();
        let begun = Instant::now();
        let end = stranger.read_to_end(&mut Vec::new());
        let is_reset = |end: io::Error| end.kind() == ErrorKind::ConnectionReset;
        assert!(end.err().is_none_or(is_reset), "{wrong:?}");
        assert!(begun.elapsed() < Duration::from_secs(3), "{wrong:?}: {:?}", begun.elapsed());
    }
    assert_connected(vec![first, connect(&hosts, 1)]);
}
